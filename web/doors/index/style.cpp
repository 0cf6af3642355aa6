// The style of the index page: two columns on a desktop, one on a phone, where each row of a table
// is a card.
#include "web/doors/index/page.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view style_sheet = R"css(:root {
  color-scheme: light dark;
  --ink: #17212b; --soft: #56636f; --line: #dde3e8; --paper: #f4f6f8; --card: #ffffff;
  --accent: #0a5cad; --live: #17693a; --live-back: #dff3e6; --quiet: #7a4b00; --quiet-back: #fbeed7;
  --code: #eef2f5;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ink: #e6ebf0; --soft: #9aa7b3; --line: #2a343d; --paper: #10161b; --card: #182027;
    --accent: #7cbcf7; --live: #8fdcab; --live-back: #173524; --quiet: #f0c77d; --quiet-back: #3a2c12;
    --code: #10161b;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; max-width: 88rem; padding: 0 clamp(1rem, 3vw, 2.5rem) 2rem;
  background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, "Segoe UI", Roboto, "Noto Sans", sans-serif;
}
a { color: var(--accent); text-underline-offset: 0.15em; }
a:focus-visible, summary:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
header { padding: 2rem 0 1.25rem; }
.brand { margin: 0; color: var(--accent); font-weight: 600; letter-spacing: 0.04em; }
h1 { margin: 0.1rem 0 0.4rem; font-size: clamp(1.6rem, 4vw, 2.2rem); line-height: 1.2; }
h1 span { color: var(--soft); font-weight: 400; overflow-wrap: anywhere; }
.lead { margin: 0; font-size: 1.1rem; }
.asof { margin: 0.2rem 0 1rem; color: var(--soft); }
nav { display: flex; flex-wrap: wrap; gap: 0.4rem 1.25rem; align-items: center; }
.button {
  padding: 0.45rem 1rem; border-radius: 0.5rem; background: var(--accent); color: var(--card);
  font-weight: 600; text-decoration: none;
}
h2 { margin: 0 0 0.75rem; font-size: 1.2rem; }
section {
  padding: 1.1rem 1.25rem; border: 1px solid var(--line); border-radius: 0.75rem;
  background: var(--card);
}
main, .data { display: grid; gap: 1.25rem; align-content: start; }
main > *, .data > * { min-width: 0; }
table { width: 100%; border-collapse: collapse; font-variant-numeric: tabular-nums; }
thead th { color: var(--soft); font-size: 0.85rem; font-weight: 500; }
th, td { padding: 0.5rem 0.75rem 0.5rem 0; text-align: left; vertical-align: top; font-weight: 400; }
tbody tr { border-top: 1px solid var(--line); }
th b { font-size: 1.05rem; }
tbody th span, td time { display: block; color: var(--soft); font-size: 0.85rem; }
td b { font-weight: 600; }
td.age { white-space: nowrap; }
.none { color: var(--soft); }
.state { white-space: nowrap; }
.state i {
  padding: 0.1rem 0.55rem; border-radius: 1rem; background: var(--live-back); color: var(--live);
  font-size: 0.85rem; font-style: normal; font-weight: 600;
}
.archive .state i { background: var(--code); color: var(--soft); }
.silent .state i { background: var(--quiet-back); color: var(--quiet); }
.links a { margin-right: 0.6rem; white-space: nowrap; }
details { border-top: 1px solid var(--line); }
details:first-of-type { border-top: 0; }
summary { padding: 0.55rem 0; cursor: pointer; font-weight: 600; }
details p { margin: 0 0 0.5rem; color: var(--soft); }
pre {
  margin: 0 0 0.9rem; padding: 0.7rem 0.85rem; overflow-x: auto; border-radius: 0.5rem;
  background: var(--code); font: 0.85rem/1.5 ui-monospace, "DejaVu Sans Mono", monospace;
}
footer { padding-top: 1.25rem; color: var(--soft); font-size: 0.9rem; }
@media (min-width: 72rem) {
  main { grid-template-columns: minmax(0, 1fr) 23rem; align-items: start; }
}
@media (min-width: 84rem) {
  td.links { white-space: nowrap; }
}
@media (max-width: 46rem) {
  thead { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
  table, tbody { display: block; }
  tbody tr {
    display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 0.35rem 0.5rem;
    padding: 0.9rem 0;
  }
  th, td { padding: 0; }
  tbody th { grid-column: 1; }
  td.state { grid-column: 2; justify-self: end; }
  td.age { white-space: normal; }
  td time { font-size: 0.8rem; }
  td.moments, td.links { grid-column: 1 / -1; }
  td.moments:empty { display: none; }
  td.age::before {
    content: attr(data-label); display: block; color: var(--soft); font-size: 0.8rem;
  }
  td.moments::before { content: attr(data-label) ": "; color: var(--soft); font-size: 0.8rem; }
  .links a { display: inline-block; padding: 0.3rem 0; margin-right: 1.1rem; }
}
)css";

}  // namespace

std::string_view index_style() {
    return style_sheet;
}

}  // namespace stormcellar::web
