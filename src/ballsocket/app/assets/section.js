// @ts-check
// Section of the joint: parts of the picture as they come, and the ball and its pressure from their numbers.
import { element, heat, parsed } from "./elements.js";

/** @param {number[]} centre  @param {number} radius  @param {number} angle */
const corner = ([x, y], radius, angle) =>
  `${(x + radius * Math.sin(angle)).toFixed(1)},${(y + radius * Math.cos(angle)).toFixed(1)}`;

/** Draw cells between radii, each for all or for each of the angles. @param {any} cells  @param {number[]} centre */
function cells({ radii, angles, percents }, centre) {
  const at = (row, column) => corner(centre, radii[row][column] ?? radii[row][0], angles[column]);
  return percents.flatMap((values, row) => values.map((percent, column) => {
    const corners = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
    const colour = heat(percent / 100);
    return `<path fill="${colour}" stroke="${colour}" stroke-width="0.4" d="M${corners.join("L")}Z"/>`;
  })).join("");
}
/** Draw the ball by its radii from the load's axis to the back. @param {any} ball  @param {number[]} centre */
function ball({ radii, tilt }, centre) {
  const step = Math.PI / (radii.length - 1);
  const side = (sign) => radii.map((radius, index) => corner(centre, radius, sign * index * step - tilt));
  return `<path class="part ball" d="M${[...side(1), ...side(-1).reverse()].join("L")}Z"/>`;
}
export function section({ size, label, data, below, cells: painted, ball: shape, above }) {
  const centre = data.centre.split(" ").map(Number);
  const grab = `<g class="grab" data-drag="load" data-how="ball">${ball(shape, centre)}</g>`;
  const parts = [...below, grab, painted ? cells(painted, centre) : "", ...above];
  const drawing = `<svg class="picture" viewBox="0 0 ${size.join(" ")}" role="group">${parts.join("")}</svg>`;
  const svg = parsed(drawing).firstElementChild;
  svg.setAttribute("aria-label", label);
  Object.assign(svg.dataset, data);
  return svg;
}
/** The colours from 0 to a value, with a note. */
export function scale({ words: [low, top, note] }) {
  const node = element("p", { class: "scale" }, element("span", {}, low), element("i"), element("span", {}, top));
  if (note) node.append(element("span", {}, note));
  return node;
}
