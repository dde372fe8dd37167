// The dialog that asks for the note of a question about the selection.

import { el } from "../shared/dom.js";

/**
 * The dialog, and what opens it.
 *
 * @param {(note: string) => void} ask gets the note
 * @returns {(about: string) => void}
 */
export function questionDialog(ask) {
    const what = el("p", { class: "quiet" });
    const note = el("textarea", { rows: 3, maxlength: 2000, required: true, "aria-label": "Question" });
    const send = el("button", { class: "primary", value: "ask" }, "Ask");
    const form = el("form", { method: "dialog" }, el("h2", {}, "Question"), what, note, el("div", { class: "row" }, send, el("button", { value: "", formnovalidate: "" }, "Cancel")));
    const dialog = el("dialog", { class: "question", "aria-label": "Question" }, form);
    note.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        if (event.key !== "Enter" || event.shiftKey) return;
        event.preventDefault();
        send.click();
    });
    dialog.addEventListener("close", () => {
        if (dialog.returnValue === "ask" && note.value.trim() !== "") ask(note.value.trim());
    });
    document.body.append(dialog);
    return (about) => {
        what.textContent = about;
        [note.value, dialog.returnValue] = ["", ""];
        dialog.showModal();
        note.focus();
    };
}
