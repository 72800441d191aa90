// Elements made in one call.

const SVG = "http://www.w3.org/2000/svg";
const DRAWN = new Set(["svg", "g", "path", "line", "rect", "circle", "text", "tspan", "polyline", "polygon", "title"]);

/** `h("button.quiet", {onclick, "aria-label": ...}, "words", child, ...)`. */
export function h(name, properties = {}, ...children) {
  const [tag, ...classes] = name.split(".");
  const element = DRAWN.has(tag) ? document.createElementNS(SVG, tag) : document.createElement(tag);
  if (classes.length) element.setAttribute("class", classes.join(" "));
  for (const [key, value] of Object.entries(properties)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "value" || key === "checked") element[key] = value;
    else element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/** `set`, called with a value only where it is another than before: what is written into the page is laid out again. */
export const whenNew = (set) => {
  let before;
  return (value) => value === before || set((before = value));
};

let mounts = 0;

/** From now on names belong to another page in the same document. */
export const begin = () => (mounts += 1);

/** A name for an element that no other page in this document has; the first page's is plain. */
export const unique = (name) => (mounts > 1 ? `${name}-${mounts}` : name);

/** h₁ as the figures write it. */
export const step = (index) => h("span.step", {}, h("i", {}, "h"), h("sub", {}, String(index)));

/** Text with quantities as the figures set them: d₁, h₂ and p + q become italic letters with indices. */
export const formulas = (said) =>
  said.split(/([dh][₁₂]|p \+ q)/).map((part) => {
    if (part === "p + q") return h("span.step", {}, h("i", {}, "p"), " + ", h("i", {}, "q"));
    return /^[dh][₁₂]$/.test(part) ? [h("i", {}, part[0]), h("sub", {}, part[1] === "₁" ? "1" : "2")] : part;
  }).flat();

const ICONS = {
  plus: "M8 3v10M3 8h10",
  minus: "M3 8h10",
  home: "M2.5 8 8 3l5.5 5M4.5 7v6h7V7",
  undo: "M6 3 3 6l3 3M3 6h6.5a3.5 3.5 0 0 1 0 7H6",
  redo: "m10 3 3 3-3 3M13 6H6.5a3.5 3.5 0 0 0 0 7H10",
  move: "M8 2v12M2 8h12M8 2 6.5 3.5M8 2l1.5 1.5M8 14l-1.5-1.5M8 14l1.5-1.5M2 8l1.5-1.5M2 8l1.5 1.5M14 8l-1.5-1.5M14 8l-1.5 1.5",
  upright: "M8 2.5v11M5.5 2.5h5M5.5 13.5h5",
  level: "M2.5 8h11M2.5 5.5v5M13.5 5.5v5",
  ratio: "M3 13 13 3M3 13h3M3 13v-3",
  theme: "M8 2.5a5.5 5.5 0 1 0 0 11zM8 2.5a5.5 5.5 0 0 1 0 11",
  close: "m4 4 8 8M12 4l-8 8",
  copy: "M6 6h7v7H6zM10 6V3H3v7h3",
};

export const icon = (name) =>
  h("svg", { viewBox: "0 0 16 16", "aria-hidden": "true", class: "icon" }, h("path", { d: ICONS[name] }));

export const iconButton = (name, label, act, more = {}) =>
  h("button.round", { type: "button", "aria-label": label, title: label, onclick: act, ...more }, icon(name));

/** Radio buttons side by side; `choices`: [[value, label, icon?]]. */
export function segmented(legend, name, choices, chosen, act) {
  const group = unique(name);
  const made = choices.map(([value, label, drawing]) => {
    const input = h("input", { type: "radio", name: group, value, checked: value === chosen, onchange: () => act(value) });
    const face = drawing ? icon(drawing) : label;
    return h("label", { title: label }, input, h("span", {}, face, drawing ? h("span.unseen", {}, label) : null));
  });
  const set = h("fieldset.segmented", {}, h("legend.unseen", {}, legend), ...made);
  set.choose = (value) => made.forEach((label) => (label.firstChild.checked = label.firstChild.value === value));
  return set;
}

/** `set(value, idle)`: `idle` says why it has nothing to do, and it cannot be ticked. */
export function checkbox(label, checked, act) {
  const input = h("input", { type: "checkbox", checked, onchange: () => act(input.checked) });
  const element = h("label.check", {}, input, h("span", {}, label));
  const set = (value, idle = "") => {
    input.checked = value && !idle;
    input.disabled = Boolean(idle);
    element.title = idle;
  };
  return Object.assign(element, { set });
}

/** Hands a file to the browser. */
export function download(name, type, content) {
  const address = URL.createObjectURL(new Blob([content], { type }));
  const link = h("a", { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
