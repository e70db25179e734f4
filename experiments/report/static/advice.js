"use strict";
// Every row of a workload times its price, as experiments/advice predicts it; works from disk.
for (const part of document.querySelectorAll(".advice")) {
  const { sizes, structures, workloads, sigmas, unmodeled, beyond } = JSON.parse(part.querySelector("script").textContent);
  const select = part.querySelector("select"), logs = sizes.map(Math.log);
  const slider = (name) => part.querySelector(`[name=${name}]`);
  const value = (name) => 10 ** Number(slider(name).value);
  workloads.forEach((it, place) => select.add(new Option(it.title, place)));

  // Beyond what was measured a price stays as it is at the last size.
  function at(costs, faces) {
    const x = Math.log(faces);
    let right = logs.findIndex((it) => it >= x);
    if (right === 0) return costs[0];
    if (right < 0) return costs[costs.length - 1];
    const part = (x - logs[right - 1]) / (logs[right] - logs[right - 1]);
    const [a, b] = [costs[right - 1], costs[right]].map((it) => Math.log(Math.max(it, 1e-15)));
    return Math.exp(a + part * (b - a));
  }

  // Seconds, and the factor by which nine of ten should be off at most.
  function forecast(structure, workload, faces) {
    const parts = workload.rows.map(([what, times, each, perFrame, inOrder, edit]) => {
      const count = times * (each ? each * faces : 1) * (perFrame ? value("frames") : 1);
      const [random, consecutive, spread] = structure.costs[what].map((costs) => at(costs, faces));
      const price = (1 - inOrder) * random + inOrder * consecutive;
      return [count * (edit ? value("edits") : 1) * price, spread];
    });
    const total = parts.reduce((sum, [seconds]) => sum + seconds, 0), last = logs[logs.length - 1];
    const outside = beyond * Math.max(0, logs[0] - Math.log(faces), Math.log(faces) - last);
    const shares = parts.map(([seconds, spread]) => (total ? (seconds / total) * (spread + outside) : 0));
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
    }
    const workload = workloads[select.value], faces = 2 * value("vertices");
    const found = structures.map((it) => [it.title, ...forecast(it, workload, faces)]);
    found.sort((a, b) => a[1] - b[1]);
    part.querySelector("tbody").replaceChildren(...found.map(([title, s, off]) => {
      const row = document.createElement("tr"), within = `${words(s / off)} … ${words(s * off)}`;
      for (const text of [title, words(s), within, `${digits(s / found[0][1])} ×`]) row.insertCell().textContent = text;
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
