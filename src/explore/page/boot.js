// The page on its own: mounted below the address that it was served from.

import { mount } from "./main.js";

const shown = mount(document.getElementById("explore"));
// For whoever drives the page, such as a test.
window.kickdrift = shown;
