// Types of three.js, for the checks; browsers never ask for this file.
export * from "../../browser/node_modules/@types/three";
