// The place of a handle, by its share among those that can be seen.
(share) => {
  const handles = [...document.querySelectorAll("#press-section [data-drag]")];
  if (!handles.length) return null;
  const handle = handles[Math.floor(share * handles.length)], { x, y, width, height } = handle.getBoundingClientRect();
  return [handle.dataset.drag, { x, y, width, height }];
}
