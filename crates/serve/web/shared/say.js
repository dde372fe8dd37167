// What screen readers are told.

import { byId } from "./dom.js";

/** @param {string} text */
export const say = (text) => (byId("live").textContent = text);
