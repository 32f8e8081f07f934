// Draws the formulas of a page.
addEventListener("DOMContentLoaded", () => {
  for (const element of document.querySelectorAll(".formula"))
    katex.render(element.textContent, element, {displayMode: element.classList.contains("block"), throwOnError: false});
});
