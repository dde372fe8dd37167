// Comparing names of pieces.

/** A name without the numbers at the ends of its words: `sofa_1/seat_cushion_2` is `sofa/seat_cushion`. @param {string} name */
export const stem = (name) => name.toLowerCase().replace(/([\s._~#-]*\d+)+(?=\/|$)/gu, "");
