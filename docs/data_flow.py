# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
"""Draw docs/figures/data_flow.svg: who publishes what to whom."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from pathlib import Path

FIGURE = Path(__file__).parent / 'figures' / 'data_flow.svg'
WIDTH, HEIGHT = 980, 740

# Colours of the page are taken over where the viewer says whether it is light or dark.
STYLE = """
  text { font-family: system-ui, 'Segoe UI', Helvetica, Arial, sans-serif; fill: #1f2933; }
  .page { fill: #ffffff; }
  .node { fill: #dbeafe; stroke: #2563a8; stroke-width: 1.6; }
  .file { fill: #f1f3f5; stroke: #7b8794; stroke-width: 1.3; }
  .end { fill: #fdecd2; stroke: #b7681b; stroke-width: 1.3; }
  .name { font-size: 16px; font-weight: 600; }
  .what { font-size: 12.5px; }
  .topic { font-size: 12.5px; font-family: ui-monospace, Menlo, Consolas, monospace; }
  .edge { fill: none; stroke: #52606d; stroke-width: 1.5; }
  .head { fill: #52606d; }
  .soft { stroke-dasharray: 5 4; }
  @media (prefers-color-scheme: dark) {
    text { fill: #e6edf3; }
    .page { fill: #0d1117; }
    .node { fill: #12304f; stroke: #6cb0f5; }
    .file { fill: #1f252d; stroke: #8b949e; }
    .end { fill: #45300f; stroke: #e0a458; }
    .edge { stroke: #9aa7b4; }
    .head { fill: #9aa7b4; }
  }
"""


@dataclass(frozen=True)
class Box:
    """A box with a name and lines below it; kind is node, file or end."""

    x: float
    y: float
    width: float
    height: float
    kind: str
    name: str
    lines: tuple[str, ...] = ()

    def svg(self) -> str:
        """Return the box as SVG."""
        middle = self.x + 0.5 * self.width
        top = self.y + 0.5 * self.height - 8.5 * len(self.lines) + 5
        parts = [
            f'<rect class="{self.kind}" x="{self.x}" y="{self.y}" width="{self.width}" '
            f'height="{self.height}" rx="7"/>',
            f'<text class="name" x="{middle}" y="{top}" text-anchor="middle">'
            f'{escape(self.name)}</text>',
        ]
        for i, line in enumerate(self.lines):
            parts.append(
                f'<text class="what" x="{middle}" y="{top + 19 + 16 * i}" '
                f'text-anchor="middle">{escape(line)}</text>'
            )
        return '\n'.join(parts)


@dataclass(frozen=True)
class Edge:
    """An arrow through points; dashed when soft."""

    points: tuple[tuple[float, float], ...]
    soft: bool = False

    def svg(self) -> str:
        """Return the arrow as SVG."""
        places = ' '.join(f'{x},{y}' for x, y in self.points)
        kind = 'edge soft' if self.soft else 'edge'
        return f'<polyline class="{kind}" points="{places}" marker-end="url(#head)"/>'


@dataclass(frozen=True)
class Label:
    """Lines of text beside an arrow; kind is topic or what.

    `flow` names the packages at both ends of the arrow; '' is outside of the graph.
    """

    x: float
    y: float
    lines: tuple[str, ...]
    kind: str = 'topic'
    anchor: str = 'start'
    flow: tuple[str, str] | None = None

    def svg(self) -> str:
        """Return the label as SVG."""
        return '\n'.join(
            f'<text class="{self.kind}" x="{self.x}" y="{self.y + 16 * i}" '
            f'text-anchor="{self.anchor}">{escape(line)}</text>'
            for i, line in enumerate(self.lines)
        )


BOXES = (
    Box(20, 20, 176, 58, 'file', 'C3D, TRC + MOT', ('a recording you made',)),
    Box(300, 20, 150, 58, 'file', 'bag', ('MCAP or SQLite',)),
    Box(520, 20, 190, 58, 'file', 'lift play', ('or a live laboratory',)),
    Box(360, 160, 260, 64, 'node', 'motion_tracker', ('joint angles, ground reaction, lifts',)),
    Box(60, 318, 260, 64, 'node', 'lift_predictor', ('the optimal lift for this person',)),
    Box(590, 318, 260, 64, 'node', 'muscle_analyzer', ('muscle forces, torques, L5-S1 load',)),
    Box(360, 476, 260, 64, 'node', 'injury_monitor', ('limits, alarms, lifting equation',)),
    Box(60, 570, 260, 50, 'end', 'lift run', ('live view, report.html, results.mcap',)),
    Box(660, 570, 300, 50, 'end', 'the plant', ('operator acknowledges; alarm journal',)),
    Box(
        60, 660, 260, 64, 'node', 'lifting_visualization', ('person, loads, optimal lift to see',)
    ),
    Box(660, 667, 300, 50, 'end', 'RViz, Foxglove', ('or any other tool of ROS 2',)),
)
EDGES = (
    Edge(((196, 49), (298, 49))),
    Edge(((450, 49), (518, 49))),
    Edge(((615, 78), (615, 112), (490, 112), (490, 158))),
    Edge(((620, 180), (690, 180))),
    Edge(((400, 224), (400, 262), (190, 262), (190, 316))),
    Edge(((580, 224), (580, 262), (720, 262), (720, 316))),
    Edge(((490, 224), (490, 474))),
    Edge(((320, 340), (588, 340))),
    Edge(((250, 382), (250, 430), (420, 430), (420, 474))),
    Edge(((100, 382), (100, 410))),
    Edge(((720, 382), (720, 430), (560, 430), (560, 474))),
    Edge(((810, 382), (810, 410))),
    Edge(((580, 540), (580, 595), (658, 595))),
    Edge(((470, 540), (470, 595), (322, 595)), soft=True),
    Edge(((470, 595), (470, 674), (322, 674)), soft=True),
    Edge(((320, 706), (658, 706))),
)
TRACKER, PREDICTOR = 'motion_tracker', 'lift_predictor'
ANALYZER, MONITOR = 'muscle_analyzer', 'injury_monitor'
VIEW = 'lifting_visualization'

LABELS = (
    Label(247, 41, ('lift import',), 'what', 'middle'),
    Label(
        626,
        100,
        (
            'markers, box/pose',
            'force_plates/{right,left}/wrench',
            'force_plates/{right,left}/wrench_block',
        ),
        flow=('', TRACKER),
    ),
    Label(20, 108, ('subject, task',)),
    Label(20, 124, ('from the bag to every node',), 'what'),
    Label(
        698,
        164,
        (
            'joint_states, lift_event',
            'ground_reaction/{wrench,cop}',
            'force_plates/{right,left}/cop',
        ),
        flow=(TRACKER, ''),
    ),
    Label(198, 254, ('measured_lift',), flow=(TRACKER, PREDICTOR)),
    Label(726, 290, ('body_motion (live)', 'measured_lift'), flow=(TRACKER, ANALYZER)),
    Label(484, 280, ('measured_lift',), 'topic', 'end', (TRACKER, MONITOR)),
    Label(405, 332, ('predicted_lift',), 'topic', 'middle', (PREDICTOR, ANALYZER)),
    Label(258, 422, ('predicted_lift',), flow=(PREDICTOR, MONITOR)),
    Label(12, 428, ('lift_comparison', 'predicted_lift/joint_trajectory'), flow=(PREDICTOR, '')),
    Label(572, 448, ('spine_load, muscle_analysis', 'joint_torques'), flow=(ANALYZER, MONITOR)),
    Label(770, 428, ('joint_reactions', 'l5_s1/reaction'), flow=(ANALYZER, '')),
    Label(590, 560, ('alarms, alarm_states', 'risk_assessment'), flow=(MONITOR, '')),
    Label(332, 562, ('results of all nodes',), 'what'),
    Label(490, 698, ('visualization, robot_description',), 'topic', 'middle', (VIEW, '')),
    Label(490, 722, ('/tf, /tf_static',), 'topic', 'middle', (VIEW, '')),
)


def draw() -> str:
    """Return the figure as SVG text."""
    parts = [part.svg() for part in (*EDGES, *BOXES, *LABELS)]
    return '\n'.join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
            f'width="{WIDTH}" height="{HEIGHT}" role="img">',
            '<title>Data flow: recording, player, five nodes, results</title>',
            f'<style>{STYLE}</style>',
            '<defs><marker id="head" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="8" '
            'markerHeight="8" orient="auto"><path class="head" d="M0,0 L10,5 L0,10 z"/></marker>'
            '</defs>',
            f'<rect class="page" width="{WIDTH}" height="{HEIGHT}" rx="10"/>',
            *parts,
            '</svg>',
            '',
        ]
    )


if __name__ == '__main__':
    FIGURE.parent.mkdir(exist_ok=True)
    FIGURE.write_text(draw(), encoding='utf-8')
    print(FIGURE)
