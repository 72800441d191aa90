// The page on its own: mounted below the address that it was served from.

import { mount } from "./main.js";

/** What the server wrote into the page, so that it need not be asked for. */
const written = document.getElementById("begun").textContent;
// For whoever drives the page, such as a test.
window.kickdrift = mount(document.getElementById("explore"), { begun: written ? JSON.parse(written) : null });
