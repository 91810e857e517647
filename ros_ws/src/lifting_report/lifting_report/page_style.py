# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Style sheet of the report page; no fonts, scripts or images from elsewhere."""

_LIGHT = """
  --paper: #ffffff; --page: #f5f4f1; --ink: #1d2126; --soft: #6c737b; --grid: #e3e4e3;
  --line: #dcdcd8; --measured: #14568f; --predicted: #bf5700; --limit: #8a6100;
  --hazard: #b3202a; --box: #c9b79a; --good: #1c7044; --action: #8a6100;
  --good-back: #e6f3ea; --action-back: #fbf1d9; --hazard-back: #fbe5e4; --none-back: #efeeea;
  --series-1: #14568f; --series-2: #bf5700; --series-3: #007a5a; --series-4: #9c3f79;
  --series-5: #8a6100; --series-6: #2f8fc4; --series-7: #5b5f66;
"""

_DARK = """
  --paper: #1b1e22; --page: #131518; --ink: #e8e7e3; --soft: #9aa1a9; --grid: #33373c;
  --line: #363a40; --measured: #74b3ee; --predicted: #f39b4f; --limit: #e0b34c;
  --hazard: #ff7b76; --box: #6d624f; --good: #6fcf97; --action: #e0b34c;
  --good-back: #1c3427; --action-back: #3a3019; --hazard-back: #421f20; --none-back: #26292e;
  --series-1: #74b3ee; --series-2: #f39b4f; --series-3: #4fcfa5; --series-4: #e08fc0;
  --series-5: #e0b34c; --series-6: #a5d8f5; --series-7: #b9bec5;
"""

CSS = (
    f"""
:root {{ color-scheme: light dark; {_LIGHT} }}
@media (prefers-color-scheme: dark) {{ :root {{ {_DARK} }} }}
"""
    + """
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
svg text { font-family: inherit; }
figure svg text { paint-order: stroke; stroke: var(--paper); stroke-width: 2.5px;
  stroke-linejoin: round; }
main { max-width: 1080px; margin: 0 auto; padding: 28px 24px 60px; }
h1 { font-size: 28px; line-height: 1.2; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 21px; margin: 44px 0 10px; letter-spacing: -0.005em; }
h3 { font-size: 16px; margin: 26px 0 6px; }
p { margin: 6px 0; max-width: 76ch; }
.lead { font-size: 16.5px; }
.note, figcaption, .source { color: var(--soft); font-size: 13px; }
.simulated { max-width: none; background: var(--action-back); color: var(--action);
  border: 1.5px solid var(--action); border-radius: 8px; padding: 10px 16px; margin: 14px 0;
  font-size: 15px; }
.simulated strong { letter-spacing: 0.06em; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(165px, 1fr));
  gap: 10px 22px; margin: 18px 0 6px; padding: 16px 18px; background: var(--paper);
  border: 1px solid var(--line); border-radius: 10px; }
.facts div { min-width: 0; overflow-wrap: anywhere; }
.facts dt, .card .what { color: var(--soft); font-size: 12px; letter-spacing: 0.02em; }
.facts dd { margin: 0; font-weight: 600; }
dl { margin: 0; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(230px, 1fr)); gap: 14px;
  margin: 14px 0; }
.card { background: var(--paper); border: 1px solid var(--line); border-radius: 10px;
  border-left: 6px solid var(--soft); padding: 12px 16px 12px; break-inside: avoid; }
.card .value { font-size: 27px; font-weight: 650; line-height: 1.25;
  font-variant-numeric: tabular-nums; }
.card .value small { font-size: 14px; font-weight: 500; color: var(--soft); }
.card .verdict { font-weight: 600; font-size: 13.5px; }
.card ul { list-style: none; margin: 8px 0 0; padding: 8px 0 0; border-top: 1px solid
  var(--line); font-size: 13px; }
.card li { display: flex; justify-content: space-between; gap: 10px;
  font-variant-numeric: tabular-nums; }
.card li span:first-child { color: var(--soft); }
.good { border-left-color: var(--good); } .good .verdict { color: var(--good); }
.action { border-left-color: var(--action); } .action .verdict { color: var(--action); }
.hazard { border-left-color: var(--hazard); } .hazard .verdict { color: var(--hazard); }
.pill { display: inline-block; border-radius: 999px; padding: 1px 10px; font-size: 12.5px;
  font-weight: 600; white-space: nowrap; background: var(--none-back); color: var(--ink); }
.pill.good { background: var(--good-back); color: var(--good); }
.pill.action { background: var(--action-back); color: var(--action); }
.pill.hazard { background: var(--hazard-back); color: var(--hazard); }
figure { margin: 12px 0 18px; padding: 14px 16px 10px; background: var(--paper);
  border: 1px solid var(--line); border-radius: 10px; break-inside: avoid; }
figure h4 { margin: 0 0 6px; font-size: 15px; }
figcaption { margin-top: 6px; max-width: 92ch; }
.scroll { overflow-x: auto; background: var(--paper); border: 1px solid var(--line);
  border-radius: 10px; margin: 10px 0 16px; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px;
  font-variant-numeric: tabular-nums; }
th, td { padding: 7px 12px; text-align: left; vertical-align: top;
  border-top: 1px solid var(--line); }
thead th { border-top: 0; color: var(--soft); font-weight: 600; font-size: 12.5px; }
td.number, th.number { text-align: right; } td.number { white-space: nowrap; }
thead th { vertical-align: bottom; }
tbody tr { break-inside: avoid; }
.absent { border: 1.5px dashed var(--line); border-radius: 10px; padding: 10px 16px;
  margin: 10px 0; color: var(--soft); font-size: 14px; }
.absent strong { color: var(--ink); }
details { margin: 18px 0; border-top: 2px solid var(--line); }
details > summary { cursor: pointer; padding: 12px 0; font-size: 19px; font-weight: 650; }
details > summary .pill { margin-left: 10px; vertical-align: 2px; }
.measured { color: var(--measured); font-weight: 600; }
.predicted { color: var(--predicted); font-weight: 600; }
ul.plain { padding-left: 20px; max-width: 84ch; } ul.plain li { margin: 4px 0; }
@media print {
  :root {"""
    + _LIGHT
    + """ --page: #ffffff; color-scheme: light; }
  figure svg text { paint-order: stroke; stroke: var(--paper); stroke-width: 2.5px;
  stroke-linejoin: round; }
main { max-width: none; padding: 0; } body { font-size: 11.5px; }
  details > summary { list-style: none; }
  h2, h3, summary { break-after: avoid; } h2 { margin-top: 24px; }
  .scroll { overflow: visible; } table { font-size: 9.5px; } thead th { font-size: 9px; }
  th, td { padding: 3px 6px; } .pill { font-size: 9px; padding: 0 6px; white-space: normal; }
  .cards { grid-template-columns: repeat(4, 1fr); gap: 8px; } .card { padding: 8px 10px; }
  .card .value { font-size: 18px; } .card .value small { font-size: 10px; }
  .card ul, .card .verdict { font-size: 9.5px; } .card .what { font-size: 9.5px; }
  .note, figcaption, .source { font-size: 10px; }
}
@page { size: A4; margin: 14mm; }
"""
)

#: Opens every lift before printing, as closed ones would be left out.
SCRIPT = (
    "addEventListener('beforeprint',()=>document.querySelectorAll('details')"
    '.forEach(d=>{d.open=true}))'
)
