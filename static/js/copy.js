// Copy buttons beside texts.

async function copied(source) {
  if (navigator.clipboard) {
    await navigator.clipboard.writeText(source.textContent);
    return;
  }
  // Browsers give pages no clipboard over plain http from another machine: the selection is what remains.
  getSelection().selectAllChildren(source);
  if (!document.execCommand("copy")) throw new Error("no clipboard");
}

export function offerCopies(root) {
  for (const button of root.querySelectorAll("[data-copy]")) {
    button.hidden = false;
    button.setAttribute("aria-live", "polite");
    button.addEventListener("click", async () => {
      const source = document.getElementById(button.dataset.copy);
      try {
        await copied(source);
        button.textContent = "Copied";
      } catch {
        getSelection().selectAllChildren(source);
        button.textContent = "Press Ctrl+C";
      }
      button.addEventListener("blur", () => (button.textContent = "Copy"), { once: true });
    });
  }
}
