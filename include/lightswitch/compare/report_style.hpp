#pragma once

// How a report looks: light or dark as the reader's system asks, from a phone's width to a desk's.

#include <lightswitch/core/floating_point.hpp>

namespace lightswitch::detail {

inline constexpr const char* report_style = R"css(
:root {
  color-scheme: light dark;
  --paper: #f6f7f8; --panel: #ffffff; --ink: #1b2127; --muted: #596470; --line: #d8dde2; --accent: #0a5fbd;
  --accent-soft: #e3eefb; --stage: #dfe3e7; --s0: #0a5fbd; --s1: #c8501e; --s2: #14795a; --s3: #8b3fb0; --s4: #9a6b00;
  --s5: #c02a63; --s6: #267f99; --s7: #5f6670;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #121518; --panel: #1b1f24; --ink: #e4e8ec; --muted: #9ba6b1; --line: #343b43; --accent: #74b4ff;
    --accent-soft: #20344c; --stage: #0b0d0f; --s0: #74b4ff; --s1: #ff9a66; --s2: #55cfa4; --s3: #d09bf2; --s4: #e2bb55;
    --s5: #ff86b0; --s6: #62c6e2; --s7: #aab2bb;
  }
}
* { box-sizing: border-box; }
[hidden] { display: none !important; }
body {
  margin: 0 auto; padding: 20px 24px 48px; max-width: 1600px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", "Liberation Sans",
  sans-serif;
}
h1 { margin: 0 0 8px; font-size: 22px; line-height: 1.25; font-weight: 650; overflow-wrap: anywhere; }
.summary { border-left: 3px solid var(--accent); padding: 1px 0 1px 14px; margin: 0 0 16px; max-width: 90ch; }
.summary p { margin: 4px 0; white-space: pre-line; overflow-wrap: anywhere; }
section { margin: 0 0 24px; }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }

.bar { display: flex; flex-wrap: wrap; gap: 8px 18px; align-items: center; margin: 0 0 8px; }
.bar > span, .bar > label, .segments { display: inline-flex; align-items: center; gap: 6px; min-width: 0; }
.bar .name { color: var(--muted); white-space: nowrap; }
button, select, input[type="number"] {
  font: inherit; font-size: 14px; color: var(--ink); background: var(--panel); border: 1px solid var(--line);
  border-radius: 6px; height: 32px; padding: 0 10px;
}
select { max-width: 240px; min-width: 0; text-overflow: ellipsis; padding: 0 6px; }
button:hover, select:hover { border-color: var(--muted); }
button { min-width: 32px; cursor: pointer; }
input[type="number"] { width: 104px; font-variant-numeric: tabular-nums; }
input[type="range"] { width: 150px; accent-color: var(--accent); margin: 0; }
input[type="checkbox"] { accent-color: var(--accent); width: 16px; height: 16px; margin: 0; }
input:disabled + span { opacity: 0.5; }
output { font-variant-numeric: tabular-nums; min-width: 4.2em; text-align: right; }
.segments {
  border: 1px solid var(--line); border-radius: 7px; padding: 2px; margin: 0; background: var(--panel); gap: 2px;
}
.segments label { position: relative; }
.segments input { position: absolute; inset: 0; opacity: 0; margin: 0; cursor: pointer; }
.segments label span { display: block; padding: 2px 13px; border-radius: 5px; font-size: 14px; font-weight: 500; }
.segments input:checked + span { background: var(--accent-soft); color: var(--accent); }
.segments input:focus-visible + span { outline: 2px solid var(--accent); outline-offset: 1px; }

.stage { display: grid; grid-template-columns: minmax(0, 1fr) 360px; gap: 16px; align-items: start; }
.panes {
  height: clamp(320px, calc(100vh - 290px), 900px); display: grid; gap: 4px; background: var(--line); overflow: hidden;
  border: 1px solid var(--line); border-radius: 6px; touch-action: none; user-select: none; -webkit-user-select: none;
}
.pane {
  position: relative; min-width: 0; min-height: 0; overflow: hidden; background: var(--stage); cursor: crosshair;
}
.pane canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; }
.tag {
  position: absolute; top: 6px; left: 6px; max-width: calc(50% - 12px); padding: 1px 8px; border-radius: 4px;
  font-size: 13px;
  background: rgb(20 24 28 / 78%); color: #fff; overflow: hidden; text-overflow: ellipsis; white-space: nowrap;
  pointer-events: none;
}
.tag.right { left: auto; right: 6px; }
.tag.whole { max-width: calc(100% - 12px); }
.divider { position: absolute; top: 0; bottom: 0; width: 25px; margin-left: -12px; cursor: ew-resize; }
.divider::before {
  content: ""; position: absolute; top: 0; bottom: 0; left: 11px; width: 3px; background: #fff;
  box-shadow: 0 0 0 1px rgb(0 0 0 / 55%);
}
.divider::after {
  content: "\2194"; position: absolute; top: calc(50% - 14px); left: -1px; width: 28px; height: 28px;
  border-radius: 50%;
  background: #fff; color: #1b2127; text-align: center; font: 16px/27px sans-serif;
  box-shadow: 0 0 0 1px rgb(0 0 0 / 55%);
}
.divider:focus-visible { outline: none; }
.divider:focus-visible::after { box-shadow: 0 0 0 3px var(--accent); }
.side { display: grid; gap: 12px; min-width: 0; }
.panel.legend { max-width: 480px; padding: 12px 40px; font-size: 13px; font-variant-numeric: tabular-nums; }
.legend .ramp { height: 14px; border: 1px solid var(--line); border-radius: 3px; }
.legend .ticks { position: relative; height: 20px; }
.legend .ticks span { position: absolute; transform: translateX(-50%); white-space: nowrap; }
.legend .what { color: var(--muted); text-align: center; }
.panel {
  background: var(--panel); border: 1px solid var(--line); border-radius: 6px; padding: 12px 14px; min-width: 0;
}
.panel table { table-layout: fixed; width: 100%; font-size: 13px; }
.panel td, .panel th { padding: 3px 0 3px 6px; }
.panel td:first-child, .panel th:first-child { padding-left: 0; overflow-wrap: anywhere; }
.panel col.value { width: 76px; }
.used { color: var(--accent); font-size: 12px; margin-left: 5px; }
.panel .number { white-space: nowrap; }
.hint { color: var(--muted); font-size: 13px; margin: 8px 0 0; }
kbd {
  font: 12px/1.4 ui-monospace, "DejaVu Sans Mono", monospace; border: 1px solid var(--line); border-radius: 4px;
  padding: 0 4px; background: var(--panel); color: var(--ink);
}

.scroll { overflow-x: auto; margin: 0 0 20px; }
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-size: 16px; font-weight: 650; padding: 0 0 6px; }
.panel caption { font-size: 14px; }
th, td { text-align: left; padding: 5px 22px 5px 0; border-bottom: 1px solid var(--line); vertical-align: baseline; }
th { color: var(--muted); font-weight: 600; }
th[scope="row"] { color: var(--ink); font-weight: 400; }
.number { text-align: right; }
#tables td:first-child { white-space: nowrap; }

#charts {
  display: grid; grid-template-columns: repeat(auto-fit, minmax(min(420px, 100%), 1fr)); gap: 16px; align-items: start;
}
figure { margin: 0; }
figcaption { font-weight: 650; margin-bottom: 4px; }
.keys { display: flex; flex-wrap: wrap; gap: 2px 16px; margin: 0 0 4px; padding: 0; list-style: none; font-size: 13px; }
.keys li { display: inline-flex; align-items: center; gap: 6px; }
svg { display: block; max-width: 100%; overflow: visible; }
svg text { fill: var(--muted); font-size: 12px; }
svg .axis { stroke: var(--muted); fill: none; }
svg .grid { stroke: var(--line); }
svg .curve { fill: none; stroke-width: 2; stroke-linejoin: round; }
svg .ideal { fill: none; stroke-width: 1.25; stroke-dasharray: 5 4; opacity: .8; }
svg .level { stroke: var(--muted); stroke-width: 1.5; stroke-dasharray: 2 3; }
svg .bin { fill: var(--s0); }
svg .expected { stroke: var(--s1); stroke-width: 2; stroke-dasharray: 6 4; }
.error { border: 1px solid var(--s1); border-radius: 6px; padding: 10px 14px; background: var(--panel); }

@media (max-width: 980px) {
  .stage { grid-template-columns: minmax(0, 1fr); }
  .panes { height: clamp(280px, 60vh, 900px); }
}
@media (max-width: 560px) {
  body { padding: 14px 14px 32px; }
  h1 { font-size: 20px; }
  .bar { gap: 8px 12px; }
  .segments { width: 100%; }
  .segments label { flex: 1; text-align: center; }
  .segments label span { padding: 4px 2px; }
  .bar > .choice { width: 100%; }
  .bar > .choice select { flex: 1; max-width: none; }
}
@media print { .bar, .hint, .divider { display: none; } }
)css";

}  // namespace lightswitch::detail
