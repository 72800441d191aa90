// The page on its own: mounted below the address that it was served from.

import { mount } from "./main.js";

/** What the server wrote into the page, so that it need not be asked for. */
const written = document.getElementById("begun").textContent;
// For whoever drives the page, such as a test.
window.kickdrift = mount(document.getElementById("explore"), { begun: written ? JSON.parse(written) : null });

/** Whoever takes a picture of a page waits for it to load: it has loaded once its own first picture is whole, or after so many ms. */
const PATIENCE = 20000;
const loading = document.body.appendChild(Object.assign(document.createElement("iframe"), { hidden: true }));
// A page loads with all its frames, and a document that is being written has not loaded.
loading.contentDocument.open();
const patience = new Promise((resolve) => setTimeout(resolve, PATIENCE));
Promise.race([window.kickdrift.whole, window.kickdrift.ready.then(() => window.kickdrift.map?.idle || patience), patience]).then(() => {
  loading.contentDocument?.close();
  loading.remove();
});
