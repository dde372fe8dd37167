// Making and finding elements of a page, for all pages.

/**
 * An element with properties and children.
 *
 * A function is a listener: `onclick` listens to `click`. `class`, `role`, `for`, names with a dash and what the element has no property for
 * become attributes. Properties that are null or undefined are left out, and children that are null.
 *
 * @param {string} tag
 * @param {Record<string, any>} [properties]
 * @param {(Node | string | null)[]} children
 * @returns {any} the element
 */
export function el(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(properties)) {
        if (value === null || value === undefined) continue;
        if (typeof value === "function") element.addEventListener(name.replace(/^on/, ""), value);
        else if (name in element && !name.includes("-") && name !== "role") /** @type {any} */ (element)[name] = value;
        else element.setAttribute(name, String(value));
    }
    element.append(...children.filter((child) => child !== null));
    return element;
}

/** The element with this id. @param {string} id @returns {any} */
export function byId(id) {
    const found = document.getElementById(id);
    if (!found) throw new Error(`the page has no element "${id}"`);
    return found;
}

/** A list of names and values; those without a value are left out. @param {[string, any][]} rows */
export function facts(rows) {
    const told = rows.filter(([, value]) => value !== null && value !== undefined && value !== "");
    return el("dl", { class: "facts" }, ...told.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value instanceof Node ? value : String(value))]));
}

/** A number with thin spaces between thousands. @param {number} value */
export const spaced = (value) => Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f");
