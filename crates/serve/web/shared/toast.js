// Messages at the corner of the page, which go away by themselves.

import { el } from "./dom.js";

/** How long a message stays, milliseconds: problems have more to read. */
const SHOWN_MS = { bad: 9000, good: 4000 };

// There before the first message, so that screen readers hear each of them.
const corner = el("div", { id: "toasts", "aria-live": "polite" });
document.body.append(corner);

/**
 * Shows a message; screen readers are told at once when it is a problem.
 *
 * @param {string} message
 * @param {string} [help] what to do
 * @param {"bad" | "good"} [kind]
 */
export function toast(message, help = "", kind = "bad") {
    const box = el("div", { class: `toast ${kind}`, role: kind === "bad" ? "alert" : null }, el("p", {}, message), help ? el("p", { class: "quiet" }, help) : null);
    corner.append(box);
    while (corner.children.length > 4) corner.firstElementChild?.remove();
    setTimeout(() => box.remove(), SHOWN_MS[kind]);
}

/** Shows a problem: an ApiError with its help, or any other. @param {any} error */
export const toastError = (error) => toast(error?.message ?? String(error), error?.help ?? "");
