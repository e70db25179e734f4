"use strict";
// Every row of a workload times its price, as experiments/advice predicts it; works from disk.
for (const part of document.querySelectorAll(".advice")) {
  const { sizes, structures, workloads, sigmas, unmodeled } = JSON.parse(part.querySelector("script").textContent);
  const select = part.querySelector("select"), logs = sizes.map(Math.log);
  const slider = (name) => part.querySelector(`[name=${name}]`);
  const value = (name) => 10 ** Number(slider(name).value);
  workloads.forEach((it, place) => select.add(new Option(it.title, place)));

  // At so many faces, along the line between two sizes, or on beyond the last.
  function at(values, faces) {
    const x = Math.log(faces), found = logs.findIndex((it) => it >= x);
    const right = Math.max(1, found < 0 ? logs.length - 1 : found), [a, b] = [values[right - 1], values[right]];
    return a + ((x - logs[right - 1]) / (logs[right] - logs[right - 1])) * (b - a);
  }

  // Seconds, and the factor by which nine of ten should be off at most. Prices are those half-way through the edits.
  function forecast(structure, workload, faces) {
    const count = ([, times, each, perFrame, , edit]) =>
      times * (each ? each * faces : 1) * (perFrame ? value("frames") : 1) * (edit ? value("edits") : 1);
    const gained = workload.rows.reduce((sum, row) => sum + row[6] * count(row), 0);
    const middle = Math.max(8, faces / 8, faces + gained / 2);
    const parts = workload.rows.map((row) => {
      const [random, consecutive, spread] = structure.costs[row[0]], inOrder = row[4];
      const [apart, near] = [random, consecutive].map((it) => Math.exp(at(it.map((cost) => Math.log(Math.max(cost, 1e-15))), middle)));
      return [count(row) * ((1 - inOrder) * apart + inOrder * near), at(spread, middle)];
    });
    const total = parts.reduce((sum, [seconds]) => sum + seconds, 0);
    const shares = parts.map(([seconds, spread]) => (total ? (seconds / total) * spread : 0));
    return [total, Math.exp(sigmas * Math.hypot(unmodeled, ...shares))];
  }

  const digits = (x) => (x < 10 ? x.toPrecision(2) : Math.round(x).toLocaleString("en"));

  function words(s) {
    const [size, unit] = [[1, "s"], [1e-3, "ms"], [1e-6, "µs"]].find(([it]) => s >= it) ?? [1e-9, "ns"];
    return `${digits(s / size)} ${unit}`;
  }

  function show() {
    for (const name of ["vertices", "frames", "edits"]) {
      slider(name).nextElementSibling.textContent = digits(value(name));
      slider(name).setAttribute("aria-valuetext", digits(value(name))); // its own value is a logarithm
    }
    const workload = workloads[select.value], faces = 2 * value("vertices");
    const found = structures.map((it) => [it.title, ...forecast(it, workload, faces)]);
    found.sort((a, b) => a[1] - b[1]);
    part.querySelector("tbody").replaceChildren(...found.map(([title, s, off]) => {
      const row = document.createElement("tr"), within = `${words(s / off)} … ${words(s * off)}`;
      row.append(Object.assign(document.createElement("th"), { scope: "row", textContent: title }));
      for (const text of [words(s), within, `${digits(s / found[0][1])} ×`]) row.insertCell().textContent = text;
      return row;
    }));
  }

  function choose() {
    slider("frames").value = Math.log10(workloads[select.value].frames);
    show();
  }
  select.addEventListener("input", choose);
  part.querySelectorAll("input").forEach((it) => it.addEventListener("input", show));
  choose();
}
