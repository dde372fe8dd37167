// Comparing names of pieces and classes.

/** A name without the numbers at the ends of its words: `sofa_1/seat_cushion_2` is `sofa/seat_cushion`, `Note3_Mesh075` is `note_mesh`. @param {string} name */
export const stem = (name) => name.toLowerCase().replace(/([\s._~#-]*\d+)+(?=[\s._~#/-]|$)/gu, "");

/** What a search compares: without capitals and accents, so that "tur" finds "Tür". @param {string} text */
export const folded = (text) => text.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase().replaceAll("ß", "ss").trim();

/** True when the text has every word of the search. @param {string} text @param {string} search */
export const matches = (text, search) => folded(search).split(/\s+/u).every((word) => folded(text).includes(word));
