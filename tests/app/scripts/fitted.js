// The width of what is on the page two frames after it has fitted its tables to a window; nothing else follows.
async (width) => {
  for (let frames = 0; frames < 3; frames += innerWidth === width) await new Promise(requestAnimationFrame);
  return document.documentElement.scrollWidth;
}
