// The dialog that asks before much is done at once.

import { el } from "../shared/dom.js";

/**
 * The dialog, and what asks with it.
 *
 * @returns {(question: string, consequence: string, yes: string) => Promise<boolean>}
 */
export function confirmDialog() {
    const [title, text] = [el("h2", {}), el("p", { class: "quiet words" })];
    const yes = el("button", { class: "primary", value: "yes", autofocus: true });
    const form = el("form", { method: "dialog" }, title, text, el("div", { class: "row" }, yes, el("button", { value: "" }, "Cancel")));
    const dialog = el("dialog", { class: "question", "aria-label": "Confirm" }, form);
    document.body.append(dialog);
    return (question, consequence, action) => {
        [title.textContent, text.textContent, yes.textContent, dialog.returnValue] = [question, consequence, action, ""];
        dialog.showModal();
        return new Promise((answer) => dialog.addEventListener("close", () => answer(dialog.returnValue === "yes"), { once: true }));
    };
}
