// Lists that are one tab stop: arrow keys go from entry to entry, and Tab leaves the list.

/**
 * Makes the entries of an element one tab stop. Returns what is to be called when its entries have changed.
 * @param {HTMLElement} element
 * @param {string} selector of the entries
 * @param {[back: string, on: string]} keys
 */
export function roving(element, selector, [back, on]) {
    const entries = () => /** @type {HTMLElement[]} */ ([...element.querySelectorAll(selector)]);
    const enter = (/** @type {HTMLElement | undefined} */ one) => {
        for (const entry of entries()) entry.tabIndex = entry === one ? 0 : -1;
    };
    element.addEventListener("focusin", (event) => {
        const entry = /** @type {HTMLElement} */ (event.target).closest(selector);
        if (entry) enter(/** @type {HTMLElement} */ (entry));
    });
    element.addEventListener("keydown", (event) => {
        const all = entries();
        const at = all.indexOf(/** @type {HTMLElement} */ (/** @type {HTMLElement} */ (event.target).closest(selector)));
        if (at < 0 || event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
        const to = { [back]: at - 1, [on]: at + 1, Home: 0, End: all.length - 1 }[event.key];
        if (to === undefined) return;
        all[Math.min(all.length - 1, Math.max(0, to))].focus();
        event.preventDefault();
        event.stopPropagation();
    });
    return () => {
        const all = entries();
        const current = all.find((entry) => entry.matches("[aria-current=true], [aria-selected=true]"));
        enter(all.find((entry) => entry === document.activeElement) ?? current ?? all[0]);
    };
}
