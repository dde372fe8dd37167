// The line at the bottom of the page that says something in passing.

import { byId } from "../shared/dom.js";

const SHOWN_MS = 2500;

let timer = 0;

/** Shows a short message. @param {string} text */
export function showNotice(text) {
    const element = byId("toast");
    element.textContent = text;
    element.classList.add("shown");
    clearTimeout(timer);
    timer = setTimeout(() => element.classList.remove("shown"), SHOWN_MS);
}
