"use strict";
// Drawings of records can be read without this. With it a click chooses a record, whose references
// are drawn and can be followed; the frames of an operation are shown one at a time.
(() => {
  const SVG = "http://www.w3.org/2000/svg", BEND = 0.14, CLEAR = 7, HEAD = 6;
  const words = (name) => name.replace("half_edge", "half-edge").replaceAll("_", " ");
  const unit = ([x, y]) => { const n = Math.hypot(x, y) || 1; return [x / n, y / n]; };

  function element(name, attributes, text = "") {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
  }

  function button(text, click) {
    const made = document.createElement("button");
    made.textContent = text;
    made.addEventListener("click", click);
    return made;
  }

  // As drawings.bent draws it.
  function bent(from, to) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]), clear = Math.min(CLEAR, 0.15 * length);
    const way = unit([to[0] - from[0], to[1] - from[1]]), side = [way[1], -way[0]];
    const [a, b] = [from.map((it, i) => it + clear * way[i]), to.map((it, i) => it - clear * way[i])];
    const control = a.map((it, i) => (it + b[i]) / 2 + BEND * length * side[i]);
    const [x, y] = unit([b[0] - control[0], b[1] - control[1]]);
    const back = [b[0] - HEAD * x, b[1] - HEAD * y], wide = HEAD * 0.6;
    const line = `M${a}Q${control} ${b}`;
    const head = [1, -1].map((k) => `M${b}L${back[0] + k * wide * y} ${back[1] - k * wide * x}`);
    const anchor = Math.abs(side[0]) < 0.4 ? "middle" : side[0] > 0 ? "start" : "end";
    const at = a.map((it, i) => 0.09 * it + 0.42 * control[i] + 0.49 * b[i] + 6 * side[i]);
    return { d: line + head.join(""), words: { x: at[0], y: at[1], style: `text-anchor:${anchor}` } };
  }

  function explore(figure) {
    const records = JSON.parse(figure.querySelector("script").textContent);
    const told = figure.querySelector(".told"), pointers = figure.querySelector(".pointers");
    const shapes = new Map([...figure.querySelectorAll("[data-at]")].map((it) => [it.dataset.at, it]));
    let chosen = figure.querySelector(".chosen")?.dataset.at;
    const place = (shape) => [Number(shape.dataset.x), Number(shape.dataset.y)];

    function reference(start, field, target, value) {
      const end = shapes.get(`${target} ${value}`);
      if (value < 0) return "none";
      if (!end) return `${words(target)} ${value}`;
      const way = bent(place(start), place(end));
      pointers.append(element("path", { d: way.d }), element("text", way.words, words(field)));
      end.classList.add("pointed");
      return chooser(end.dataset.at);
    }

    function chooser(key) { // for the keyboard as well, which then goes on from the first reference
      return button(words(key), () => { choose(key); told.querySelector("button")?.focus(); });
    }

    function choose(key) {
      const start = shapes.get(key), record = records[key];
      for (const it of shapes.values()) it.classList.remove("chosen", "pointed");
      start.classList.add("chosen");
      pointers.replaceChildren();
      const line = document.createElement("p"), name = document.createElement("b");
      const [kind] = key.split(" ");
      name.textContent = record ? words(key) : `this ${words(kind)}`;
      line.append(name);
      if (!record) line.append(" has no record: the structure keeps nothing of it.");
      else if (!record.length) line.append(" refers to nothing.");
      for (const [field, target, values] of record || []) {
        line.append(` · ${words(field)} → `);
        values.forEach((value, k) => line.append(k ? ", " : "", reference(start, field, target, value)));
      }
      if (chosen && !line.querySelector("button")) line.append(" Back to ", chooser(chosen));
      chosen = key;
      told.replaceChildren(line);
    }

    for (const it of told.querySelectorAll("b")) it.replaceWith(chooser(it.dataset.record));
    if (!told.firstElementChild) told.append(chooser(Object.keys(records)[0]));
    for (const [key, shape] of shapes) shape.addEventListener("click", () => choose(key));
    figure.classList.add("live");
  }

  function stepper(section) {
    const frames = [...section.querySelectorAll("figure")];
    const back = button("‹ back", () => show(shown - 1)), on = button("step ›", () => show(shown + 1));
    const at = document.createElement("span"), controls = document.createElement("p");
    let shown = 0;
    function show(index) {
      shown = index;
      frames.forEach((it, k) => { it.hidden = k !== shown; });
      back.disabled = !shown;
      on.disabled = shown === frames.length - 1;
      at.textContent = ` ${shown + 1} of ${frames.length} `;
    }
    controls.append(back, at, on);
    frames[0].before(controls);
    section.classList.add("live");
    show(0);
  }

  document.querySelectorAll("figure.mesh:has(> script)").forEach(explore);
  document.querySelectorAll(".steps").forEach(stepper);
})();
