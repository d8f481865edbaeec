// Elements for a pointer that no stop of Tab reaches, nor a twin of theirs.
() => {
  const reached = (element) => Boolean(element.closest("[data-reached]") || element.querySelector("[data-reached]"));
  const twins = (element) => {
    const label = element.closest("label"), drag = element.closest("[data-drag]");
    if (label && label.control) return [label.control, ...radios(label.control)];
    if (element.matches("input[type=radio]")) return radios(element);
    if (drag) return [...document.querySelectorAll(`[data-drag="${drag.dataset.drag}"]`)];
    const map = element.closest("svg[data-pick]");
    return map ? [map.querySelector(".cursor")] : [];
  };
  const radios = (input) => [...document.getElementsByName(input.name || " ")];
  const seen = (element) => element.checkVisibility({ visibilityProperty: true }) && element.getClientRects().length;
  const moved = /pointer|grab|move|resize|crosshair/;
  return [...document.querySelectorAll("body *")]
    .filter((element) => seen(element) && !element.closest(":disabled"))
    .filter((element) => element.dataset.drag || moved.test(getComputedStyle(element).cursor))
    .filter((element) => !reached(element) && !twins(element).some(reached))
    .map((element) => element.outerHTML.slice(0, 160));
}
