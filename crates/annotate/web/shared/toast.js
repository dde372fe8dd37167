// Messages at the corner of the page, which go away by themselves.

import { el } from "./dom.js";

const SHOWN_MS = 9000;

/**
 * Shows a message; screen readers are told at once when it is a problem.
 *
 * @param {string} message
 * @param {string} [help] what to do
 * @param {"bad" | "good"} [kind]
 */
export function toast(message, help = "", kind = "bad") {
    const corner = document.getElementById("toasts") ?? el("div", { id: "toasts" });
    document.body.append(corner);
    const box = el("div", { class: `toast ${kind}`, role: kind === "bad" ? "alert" : "status" }, el("p", {}, message), help ? el("p", { class: "quiet" }, help) : null);
    corner.append(box);
    while (corner.children.length > 4) corner.firstElementChild?.remove();
    setTimeout(() => box.remove(), SHOWN_MS);
}

/** Shows a problem: an ApiError with its help, or any other. @param {any} error */
export const toastError = (error) => toast(error?.message ?? String(error), error?.help ?? "");
