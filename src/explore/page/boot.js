// The page on its own: mounted below the address that it was served from.

import { mount } from "./explore.js";

const shown = mount(document.getElementById("explore"));
// For whoever drives the page, such as a test.
window.kickdrift = shown;
