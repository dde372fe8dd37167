// Who labels. The name is kept in a cookie, so that it is the same on every port of this machine; who gives none is a guest with a number.

const COOKIE = "enfilade_name";
const YEAR_S = 31_536_000;
/** Longer names are a mistake, characters. */
export const LONGEST_NAME = 60;

/** The name that this browser has given, or made up. */
export function myName() {
    const pair = document.cookie.split("; ").find((one) => one.startsWith(`${COOKIE}=`));
    const known = pair ? decodeURIComponent(pair.slice(COOKIE.length + 1)) : "";
    return known || keepName(`guest ${1000 + (crypto.getRandomValues(new Uint16Array(1))[0] % 9000)}`);
}

/** Keeps a name. @param {string} name */
export function keepName(name) {
    document.cookie = `${COOKIE}=${encodeURIComponent(name)}; path=/; max-age=${YEAR_S}; SameSite=Strict`;
    return name;
}

/** How another is called. @param {string | null | undefined} who @param {string} me */
export const called = (who, me) => (who === me ? "You, in another tab" : who || "Another program");
