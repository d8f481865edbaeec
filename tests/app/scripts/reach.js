// Mark the element with the focus as reached, unless it was on it before or is on none.
() => {
  const element = document.activeElement;
  if (!element || element === document.body || element.dataset.reached) return false;
  element.dataset.reached = "yes";
  return true;
}
