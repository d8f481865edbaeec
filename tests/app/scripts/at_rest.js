// Wait until nothing was asked or changed for twenty frames; the width of the page.
async () => {
  const frame = () => new Promise(requestAnimationFrame);
  const place = document.documentElement;
  const size = () => `${place.scrollWidth} ${place.scrollHeight}`;
  for (let same = 0, last = ""; same < 20; await frame()) {
    [same, last] = size() === last && document.body.dataset.idle === "yes" ? [same + 1, last] : [0, size()];
  }
  return place.scrollWidth;
}
