// Elements in one line.

/**
 * An element with properties and children; `class`, `role` and names with a hyphen become attributes.
 * @param {string} tag
 * @param {Record<string, any>} [properties]
 * @param {...(Node | string | null | undefined | (Node | string)[])} children
 * @returns {any}
 */
export function h(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(properties)) {
        if (value === undefined || value === null) continue;
        if (name === "class" || name === "role" || name === "for" || name.includes("-")) element.setAttribute(name, value);
        else /** @type {any} */ (element)[name] = value;
    }
    element.append(...children.flat().filter((child) => child !== null && child !== undefined));
    return element;
}

/** @param {string} id @returns {any} */
export const byId = (id) => document.getElementById(id);

let toasting = 0;

/** Says something in passing. @param {string} text */
export function toast(text) {
    const element = byId("toast");
    element.textContent = text;
    element.classList.add("shown");
    clearTimeout(toasting);
    toasting = setTimeout(() => element.classList.remove("shown"), 2500);
}

/** A list of facts. @param {[string, any][]} rows */
export const facts = (rows) =>
    h("dl", { class: "facts" }, ...rows.filter(([, value]) => value !== null && value !== undefined && value !== "").flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value instanceof Node ? value : String(value))]));
