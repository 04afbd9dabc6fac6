// Copyright 2026 The pam_ros authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures a rendered page: what is missing, what overlaps, what sticks out.
// look(window of the page) gives a table of lists, each to be empty, and counts.
function look(view) {
  const page = view.document;
  const width = page.documentElement.clientWidth;
  const say = (text) => text.trim().replace(/\s+/g, ' ').slice(0, 40);
  const shown = (element) => element.checkVisibility() && element.getClientRects().length > 0;

  // Every piece of text with the boxes of its lines.
  const pieces = [];
  const walker = page.createTreeWalker(page.body, view.NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode;
    const parent = node.parentElement;
    if (!node.data.trim() || !shown(parent) || parent.closest('style, script, title')) continue;
    const range = page.createRange();
    range.selectNodeContents(node);
    for (const box of range.getClientRects()) {
      if (box.width > 0.5 && box.height > 0.5) pieces.push({ node, box, text: say(node.data) });
    }
  }

  // Lines of one text stand apart by less than their boxes' heights; the middle half counts.
  const core = ({ box }) => ({
    left: box.left + 0.5,
    right: box.right - 0.5,
    top: box.top + 0.25 * box.height,
    bottom: box.bottom - 0.25 * box.height,
  });
  const overlaps = [];
  const cores = pieces.map(core);
  const order = [...pieces.keys()].sort((a, b) => cores[a].top - cores[b].top);
  order.forEach((i, k) => {
    for (const j of order.slice(k + 1)) {
      if (cores[j].top >= cores[i].bottom) break;
      const across = Math.min(cores[i].right, cores[j].right) - Math.max(cores[i].left, cores[j].left);
      if (across > 0) overlaps.push(`${pieces[i].text} | ${pieces[j].text}`);
    }
  });

  const outside = pieces
    .filter(({ box }) => box.left < -0.5 || box.right > width + 0.5)
    .map(({ text }) => text);
  const wide = [...page.body.querySelectorAll('*')]
    .filter((e) => shown(e) && !e.closest('svg') && e.getBoundingClientRect().right > width + 1)
    .map((e) => `${e.tagName} ${e.className}`);
  if (page.documentElement.scrollWidth > width) wide.push('the page itself');

  const plots = [...page.querySelectorAll('svg.plot')].filter(shown);
  const cut = [];
  const small = [];
  const empty = [];
  for (const plot of plots) {
    const frame = plot.getBoundingClientRect();
    const name = plot.dataset.name;
    for (const text of plot.querySelectorAll('text')) {
      const box = text.getBoundingClientRect();
      const over = Math.max(frame.left - box.left, box.right - frame.right,
        frame.top - box.top, box.bottom - frame.bottom);
      if (over > 1.5) cut.push(`${name}: ${say(text.textContent)}`);
      const scale = frame.width / plot.viewBox.baseVal.width;
      const size = scale * parseFloat(view.getComputedStyle(text).fontSize);
      if (size < 9.5) small.push(`${name}: ${size.toFixed(1)} px`);
    }
    const drawn = [...plot.querySelectorAll('g[id*="line2d"] path')]
      .filter((path) => path.getTotalLength() > 30);
    if (drawn.length === 0) empty.push(name);
  }
  const missing = [...page.querySelectorAll('h1, h2, h3, section, figure, table')]
    .filter((e) => shown(e) && (e.getBoundingClientRect().height < 8 || !e.textContent.trim()))
    .map((e) => `${e.tagName} ${e.id}`);
  return {
    problems: { overlaps, outside, wide, cut, small, empty, missing },
    width,
    plots: plots.map((plot) => plot.dataset.name),
    sections: [...page.querySelectorAll('section')].filter(shown).map((e) => e.id),
    pieces: pieces.length,
  };
}
