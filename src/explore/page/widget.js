// The page as a guest in a notebook: questions and answers are messages of a widget.

import { mount } from "./main.js";

/** An `ask` over a widget's messages, in which a question's own number comes back with its answer; `end()` hears no more. */
function through(model) {
  const open = new Map();
  // Several views may show one model, and all hear what comes.
  const view = Math.random().toString(36).slice(2);
  let asked = 0;
  const hear = ({ id, status, type }, [view]) => {
    // A copy begins at a multiple of eight, where arrays of numbers may.
    open.get(id)?.({ status, type, bytes: new Uint8Array(view.buffer, view.byteOffset, view.byteLength).slice().buffer });
    open.delete(id);
  };
  model.on("msg:custom", hear);
  const ask = (path, params, signal) =>
    new Promise((resolve, reject) => {
      signal?.throwIfAborted();
      const id = `${view}-${(asked += 1)}`;
      open.set(id, resolve);
      model.send({ id, path, query: new URLSearchParams(params).toString() });
      signal?.addEventListener("abort", () => {
        if (open.delete(id)) model.send({ stop: id });
        reject(signal.reason);
      }, { once: true });
    });
  return { ask, end: () => model.off("msg:custom", hear) };
}

const FACES = { Regular: {}, Italic: { style: "italic" }, Semibold: { weight: "600" } };

/** The figures' faces, once in a document. */
function faces(ask) {
  document.kickdriftFaces ??= Promise.all(Object.entries(FACES).map(async ([name, how]) => {
    const { bytes } = await ask(`fonts/LibertinusSerif-${name}.otf`);
    document.fonts.add(await new FontFace("Libertinus Serif", bytes, how).load());
  }));
  return document.kickdriftFaces;
}

/** What anywidget calls for each view; returns what ends it. */
export async function render({ model, el }) {
  const { ask, end } = through(model);
  el.style.setProperty("--height", `${model.get("height")}px`);
  await faces(ask).catch(() => {});
  const shown = mount(el, { ask, own: false });
  return () => {
    shown.remove();
    end();
  };
}
