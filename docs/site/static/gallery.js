// SPDX-License-Identifier: Apache-2.0
// The filter of the gallery: words, and topics of the models. Without a script all examples are shown.
document.addEventListener("DOMContentLoaded", () => {
  const place = document.getElementById("gallery-filter");
  if (!place) return;
  const cards = [...document.querySelectorAll(".gallery .card")].map((card) => ({ card, text: card.textContent.toLowerCase(), topics: (card.querySelector(".topics")?.textContent ?? "").split(", ").filter(Boolean) }));
  const chosen = new Set(), label = document.createElement("label"), field = document.createElement("input"), buttons = document.createElement("div"), status = document.createElement("p");
  const show = () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const { card, text, topics } of cards) {
      card.hidden = !(words.every((word) => text.includes(word)) && [...chosen].every((topic) => topics.includes(topic)));
      count += !card.hidden;
    }
    for (const button of buttons.children) button.setAttribute("aria-pressed", chosen.has(button.dataset.topic));
    status.textContent = `${count} of ${cards.length} examples`;
    const at = new URLSearchParams([...(field.value ? [["words", field.value]] : []), ...[...chosen].map((topic) => ["topic", topic])]).toString();
    history.replaceState(null, "", at ? `#${at}` : location.pathname);
  };
  field.type = "search";
  field.addEventListener("input", show);
  label.append("Filter ", field);
  buttons.className = "topics-choice";
  for (const topic of [...new Set(cards.flatMap((entry) => entry.topics))].sort()) {
    const button = document.createElement("button");
    button.type = "button";
    button.dataset.topic = topic;
    button.textContent = `${topic} ${cards.filter((entry) => entry.topics.includes(topic)).length}`;
    button.onclick = () => {
      if (!chosen.delete(topic)) chosen.add(topic);
      show();
    };
    buttons.append(button);
  }
  status.setAttribute("role", "status");
  const link = new URLSearchParams(location.hash.slice(1));
  field.value = link.get("words") ?? "";
  for (const topic of link.getAll("topic")) chosen.add(topic);
  place.append(label, buttons, status);
  show();
});
