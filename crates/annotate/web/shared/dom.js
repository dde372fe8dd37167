// Elements of the page, made in one line.

/**
 * An element with these properties (`class` and names with a dash or `role` become attributes, functions become listeners) and children.
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
        else element.setAttribute(name === "className" ? "class" : name, String(value));
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

/** A number with thin spaces between thousands. @param {number} value */
export const spaced = (value) => Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, "\u202f");
