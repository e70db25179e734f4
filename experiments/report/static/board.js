"use strict";
// The board works without this: then everything is shown, and unfolds by hand.
(() => {
  const form = document.getElementById("filters"), search = document.getElementById("search");
  const shown = document.getElementById("shown"), none = document.getElementById("none");
  const entries = [...document.querySelectorAll(".entry")], every = shown.textContent;
  const buttons = [...form.querySelectorAll("button[data-group]")];
  const groups = ["outcome", "claimed", "structure", "kind"];
  const heads = entries.map((it) => it.querySelector("summary"));
  const plain = (text) => text.toLowerCase().replace(/[-_→]/g, " ").replace(/\s+/g, " ");
  const words = new Map(entries.map((it) => [it, plain([it.id, it.dataset.outcome,
    it.querySelector("summary").textContent, it.querySelector(".words").textContent].join(" "))]));

  function reachable(head) { // by Tab: one of many claims, the others from it by arrow keys
    for (const it of heads) it.tabIndex = it === head ? 0 : -1;
  }

  function chosen(group) {
    return buttons.filter((it) => it.dataset.group === group && it.ariaPressed === "true")
      .map((it) => it.dataset.value);
  }

  function update() {
    const wanted = Object.fromEntries(groups.map((group) => [group, chosen(group)]));
    const asked = plain(search.value).split(" ").filter(Boolean);
    const said = (it) => asked.every((word) => words.get(it).includes(word));
    const fits = (it, group) => !wanted[group].length || wanted[group].includes(it.dataset[group]);
    let count = 0;
    for (const it of entries) {
      it.hidden = !(said(it) && groups.every((group) => fits(it, group)));
      count += !it.hidden;
    }
    for (const button of buttons) { // how many there would be, were this one chosen in its group
      const mine = button.dataset.group, others = groups.filter((group) => group !== mine);
      const number = entries.filter((it) => it.dataset[mine] === button.dataset.value && said(it)
        && others.every((group) => fits(it, group))).length;
      button.querySelector("span").textContent = number;
      button.classList.toggle("empty", !number);
    }
    shown.textContent = count === entries.length ? every : `${count} of ${entries.length} entries`;
    none.hidden = count > 0;
    reachable(heads.find((it) => !it.parentElement.hidden));
  }

  function reset() {
    search.value = "";
    for (const button of buttons) button.ariaPressed = "false";
    update();
  }

  function open() {
    const it = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!it || !it.classList.contains("entry")) return;
    if (it.hidden) reset();
    it.open = true;
    it.firstElementChild.focus({ preventScroll: true });
    it.scrollIntoView();
  }

  for (const button of buttons) {
    button.addEventListener("click", () => {
      button.ariaPressed = button.ariaPressed === "true" ? "false" : "true";
      update();
    });
  }
  document.getElementById("board").addEventListener("focusin", (event) => {
    if (heads.includes(event.target)) reachable(event.target);
  });
  document.getElementById("board").addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const seen = heads.filter((it) => !it.parentElement.hidden), from = seen.indexOf(event.target);
    if (!step || from < 0 || !seen[from + step]) return;
    event.preventDefault();
    seen[from + step].focus();
  });
  form.addEventListener("submit", (event) => event.preventDefault());
  search.addEventListener("input", update);
  document.getElementById("all").addEventListener("click", reset);
  window.addEventListener("hashchange", open);
  document.addEventListener("click", (event) => { // the same link again
    const link = event.target.closest("a");
    if (link && link.href === location.href) open();
  });
  form.hidden = false;
  update();
  open();
})();
