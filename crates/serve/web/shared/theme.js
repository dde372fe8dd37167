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
    const other = getComputedStyle(root).colorScheme === "dark" ? "light" : "dark";
    root.dataset.theme = other;
    localStorage.setItem(STORE, other);
}
