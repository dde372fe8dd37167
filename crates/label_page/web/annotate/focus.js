// Where the keys go after a click on a control: back to the view.

/** Controls that keep nothing to do for the keyboard once they are clicked. */
const CONTROLS = "button, select, input[type=checkbox], input[type=range]";

/**
 * Gives the focus back to the view after a control was used by pointer, so that the next key is a command and does not press the control
 * again. Whoever moves by Tab stays where they are.
 *
 * @param {HTMLElement} view
 */
export function focusReturnsTo(view) {
    let byPointer = false;
    window.addEventListener("pointerdown", () => (byPointer = true), { capture: true });
    window.addEventListener("keydown", () => (byPointer = false), { capture: true });
    /** @param {Event} event */
    const back = ({ type, target }) => {
        const control = target instanceof Element ? target.closest(CONTROLS) : null;
        // A list of choices is still open at its click.
        const open = type === "click" && control instanceof HTMLSelectElement;
        if (control && byPointer && !open && !document.querySelector("dialog[open]")) view.focus({ preventScroll: true });
    };
    document.addEventListener("click", back);
    document.addEventListener("change", back);
}
