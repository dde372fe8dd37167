// Dark or light: as the system has it, unless the user has chosen on one of the pages.

const STORE = "enfilade.theme";
const root = document.documentElement;

/** Shows the theme that was chosen last, if any was. */
export function takeChosenTheme() {
    const chosen = localStorage.getItem(STORE);
    if (chosen) root.dataset.theme = chosen;
}

/** Chooses the other theme. */
export function toggleTheme() {
    const shown = root.dataset.theme ?? (matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark");
    const other = shown === "dark" ? "light" : "dark";
    root.dataset.theme = other;
    localStorage.setItem(STORE, other);
}

/** A colour of the theme that is shown, as `rgb(…)`. @param {string} name Its property, such as `--ground`. */
export function themeColor(name) {
    const probe = document.createElement("span");
    probe.style.color = `var(${name})`;
    root.append(probe);
    const { color } = getComputedStyle(probe);
    probe.remove();
    return color;
}
