/* A search field above every long table: rows that lack one of its words are hidden. No request to any host. */
document.addEventListener("DOMContentLoaded", () => {
  for (const table of document.querySelectorAll("article table")) {
    const rows = [...table.querySelectorAll("tbody tr")];
    if (rows.length < 40) continue;
    const texts = rows.map((row) => row.textContent.toLowerCase());
    const box = document.createElement("div");
    const label = document.createElement("label");
    const field = document.createElement("input");
    const count = document.createElement("output");
    box.className = "table-filter";
    label.textContent = "Filter rows ";
    field.type = "search";
    field.placeholder = "CONTACT, layers, frost …";
    label.append(field);
    box.append(label, count);
    const update = () => {
      const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      rows.forEach((row, k) => {
        row.hidden = !words.every((word) => texts[k].includes(word));
        shown += row.hidden ? 0 : 1;
      });
      count.textContent = ` ${shown} of ${rows.length} rows`;
    };
    field.addEventListener("input", update);
    update();
    table.classList.add("long-table");
    (table.closest(".pst-scrollable-table-container") || table).before(box);
  }
});
