// Where the keys go: back to the view after a click on a control, and one tab stop for each group of controls.

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

/**
 * Makes the controls of a container one tab stop: arrows, Home and End move among those that are shown and enabled.
 *
 * @param {HTMLElement} container
 * @param {number} [columns] controls in a row
 */
export function oneTabStop(container, columns = 1) {
    const controls = () => /** @type {HTMLButtonElement[]} */ ([...container.querySelectorAll("button, select, input")]).filter((one) => !one.disabled && !one.hidden);
    /** @param {HTMLElement | undefined} stop */
    const stopAt = (stop) => {
        for (const one of container.querySelectorAll("button, select, input")) /** @type {HTMLElement} */ (one).tabIndex = one === stop ? 0 : -1;
    };
    container.addEventListener("focusin", (event) => stopAt(/** @type {HTMLElement} */ (event.target)));
    container.addEventListener("keydown", (event) => {
        const all = controls();
        const at = all.indexOf(/** @type {HTMLButtonElement} */ (event.target));
        const steps = /** @type {Record<string, number>} */ ({ ArrowRight: 1, ArrowLeft: -1, ArrowDown: columns, ArrowUp: -columns, Home: -1e9, End: 1e9 });
        const isChoice = event.target instanceof HTMLSelectElement && event.key !== "ArrowRight" && event.key !== "ArrowLeft";
        if (at < 0 || isChoice || !(event.key in steps)) return;
        event.preventDefault();
        all[Math.min(all.length - 1, Math.max(0, at + steps[event.key]))].focus();
    });
    // A stop that is switched off would leave the group out of reach, and one that is added would be a second.
    new MutationObserver(() => {
        const all = controls();
        if (all.filter((one) => one.tabIndex === 0).length !== 1) stopAt(all.find((one) => one === document.activeElement) ?? all[0]);
    }).observe(container, { subtree: true, childList: true, attributes: true, attributeFilter: ["disabled", "hidden"] });
    stopAt(controls()[0]);
}
