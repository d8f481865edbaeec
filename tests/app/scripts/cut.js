// Tables of the open view that are cut, or beyond the window, and text of pictures below 9 px.
() => {
  const cut = [];
  for (const table of document.querySelectorAll("section.view:not([hidden]) table")) {
    if (!table.getClientRects().length) continue;
    const place = table.closest(".wide, .narrow, .checks"), { left, right } = table.getBoundingClientRect();
    if (left < 0 || right > innerWidth + 1) cut.push(`beyond the window: ${table.textContent.slice(0, 60)}`);
    for (const box of [place, ...table.querySelectorAll("th, td")])
      if (box.scrollWidth > box.clientWidth + 1) cut.push(`cut or scrolls: ${box.textContent.slice(0, 60)}`);
  }
  for (const text of document.querySelectorAll("section.view:not([hidden]) svg text")) {
    const { a, b } = text.getScreenCTM(), size = parseFloat(getComputedStyle(text).fontSize) * Math.hypot(a, b);
    if (text.getClientRects().length && size < 9) cut.push(`small: ${text.textContent}`);
  }
  return cut;
}
