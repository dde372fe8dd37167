// Groups of controls and lists that are one tab stop: arrows move within, and Tab leaves.

/**
 * Makes the entries of a container one tab stop, also when they change: the arrows, Home and End move among those that are shown and
 * enabled. The stop is where the focus was last, else the current entry (`aria-current`, `aria-selected`), else the first.
 *
 * @param {HTMLElement} container
 * @param {object} [options]
 * @param {string} [options.entries] selector of the entries
 * @param {"row" | "column" | "grid"} [options.along] which arrows move; the others are left to the page
 * @param {number} [options.columns] entries in a row of a grid
 */
export function oneTabStop(container, { entries = "button, select, input", along = "grid", columns = 1 } = {}) {
    const across = along === "column" ? {} : { ArrowLeft: -1, ArrowRight: 1 };
    const down = along === "row" ? {} : { ArrowUp: -columns, ArrowDown: columns };
    const steps = /** @type {Record<string, number>} */ ({ ...across, ...down, Home: -1e9, End: 1e9 });
    const every = () => /** @type {HTMLButtonElement[]} */ ([...container.querySelectorAll(entries)]);
    const usable = () => every().filter((one) => !one.disabled && !one.hidden);
    const entryOf = (/** @type {EventTarget | null} */ target) => /** @type {HTMLButtonElement} */ (/** @type {HTMLElement} */ (target).closest(entries));
    /** @param {HTMLElement | undefined} stop */
    const stopAt = (stop) => {
        for (const one of every()) one.tabIndex = one === stop ? 0 : -1;
    };
    /** @type {HTMLElement | null} */
    let last = null;
    const settle = () => {
        const all = usable();
        stopAt(all.find((one) => one === document.activeElement) ?? all.find((one) => one.matches("[aria-current=true], [aria-selected=true]")) ?? all.find((one) => one === last) ?? all[0]);
    };
    container.addEventListener("focusin", ({ target }) => {
        last = entryOf(target) ?? last;
        if (last && last === entryOf(target)) stopAt(last);
    });
    container.addEventListener("keydown", (event) => {
        const all = usable();
        const at = all.indexOf(entryOf(event.target));
        // A list of choices needs the arrows up and down itself.
        const isChoice = event.target instanceof HTMLSelectElement && !(event.key in across);
        if (at < 0 || isChoice || !(event.key in steps) || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
        all[Math.min(all.length - 1, Math.max(0, at + steps[event.key]))].focus();
        event.preventDefault();
        event.stopPropagation();
    });
    new MutationObserver(settle).observe(container, { subtree: true, childList: true, attributes: true, attributeFilter: ["disabled", "hidden", "aria-current", "aria-selected"] });
    settle();
}
