// The panels at the side, each behind a tab.

import { el, byId } from "../shared/dom.js";

/**
 * Puts panels behind tabs. The tabs are one tab stop; arrows move between them. A panel hears `shown` and `left`.
 *
 * @param {{ name: string, title: string, element: HTMLElement }[]} panels
 * @returns {(name: string) => void} shows one
 */
export function tabs(panels) {
    const buttons = panels.map(({ name, title, element }) => {
        element.id = `panel-${name}`;
        element.classList.add("tab");
        element.setAttribute("role", "tabpanel");
        element.setAttribute("aria-label", title);
        byId("panels").append(element);
        return el("button", { id: `tab-${name}`, role: "tab", "aria-controls": element.id, onclick: () => show(name) }, title);
    });
    byId("tabs").append(...buttons);
    byId("tabs").addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        const by = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
        if (by === 0) return;
        event.preventDefault();
        const at = panels.findIndex(({ element }) => !element.hidden);
        const next = (at + by + panels.length) % panels.length;
        show(panels[next].name);
        buttons[next].focus();
    });
    /** @param {string} name */
    function show(name) {
        panels.forEach((panel, i) => {
            const on = panel.name === name;
            if (!on && !panel.element.hidden) panel.element.dispatchEvent(new Event("left"));
            panel.element.hidden = !on;
            buttons[i].setAttribute("aria-selected", String(on));
            buttons[i].tabIndex = on ? 0 : -1;
            if (on) panel.element.dispatchEvent(new Event("shown"));
        });
    }
    show(panels[0].name);
    return show;
}
