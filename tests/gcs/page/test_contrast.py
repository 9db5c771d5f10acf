"""Whether the page can be read in sunlight: WCAG 2.2, level AA, of every shade that it uses, in both themes.

1.4.3 asks 4.5 : 1 of text, 1.4.11 asks 3 : 1 of what one must see to understand, such as vehicles and lines.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gcs.page import server
from onboard.game import palette

STYLE = (Path(server.__file__).parent / "static" / "style.css").read_text(encoding="utf-8")
TEXT, THINGS = 4.5, 3.0
SHADES = ("light", "dark")
NO_TEXT = {".mark", ".track", "::backdrop", "button:disabled", "body.lost"}  # and what WCAG exempts


def channels(colour: str) -> tuple[float, ...]:
    return tuple(int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5))


def mixed(over: str, under: str, share: float) -> str:
    """`share` of one colour over another, as browsers blend them."""
    pairs = zip(channels(over), channels(under), strict=True)
    return "#" + "".join(f"{round(255 * (share * a + (1 - share) * b)):02x}" for a, b in pairs)


def contrast(one: str, other: str) -> float:
    """The contrast ratio of WCAG 2.2."""

    def luminance(colour: str) -> float:
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels(colour)]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def variables(shade: str) -> dict[str, str]:
    """The colours that the style sheet names, in one theme."""
    found = [
        dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", block))
        for block in re.findall(r":root \{[^}]*\}", STYLE)
    ]
    light, dark = found
    assert light.keys() == dark.keys()
    return light if shade == "light" else dark


def rules() -> list[tuple[str, dict[str, str]]]:
    """Selector and declarations of every rule outside `:root`."""
    flat = re.sub(r"@\w+[^{]*\{((?:[^{}]*\{[^{}]*\})*)[^{}]*\}", r"\1", STYLE)
    pairs = re.findall(r"([^{}]+)\{([^{}]*)\}", flat)
    return [
        (selector.strip(), dict(re.findall(r"([\w-]+):\s*([^;]+)", body)))
        for selector, body in pairs
        if ":root" not in selector
    ]


def texts(shade: str) -> list[tuple[str, str, str]]:
    """Selector, text and ground of every pair that the sheet makes."""
    named = variables(shade)
    chosen = mixed(
        named["accent"],
        named["paper"],
        0.01 * float(re.search(r"tr.chosen td[^}]*accent\) (\d+)%", STYLE)[1]),
    )
    grounds = [named["paper"], named["raised"], chosen]
    found = [("body", named["ink"], ground) for ground in grounds]
    for selector, body in rules():
        if any(word in selector for word in NO_TEXT):
            continue
        ink = re.fullmatch(r"var\(--([\w-]+)\)", body.get("color", ""))
        ground = re.fullmatch(r"var\(--([\w-]+)\)", body.get("background", ""))
        inks = [named[ink[1]]] if ink else []
        under = [named[ground[1]]] if ground else grounds
        share = float(body.get("opacity", 1.0))
        if share < 1.0:
            inks = inks or [named[name] for name in ("ink", "faint", "error", "warning", "ok")]
        found += [(selector, mixed(i, g, share), g) for i in inks for g in under]
    return found


def test_the_measure_is_that_of_the_standard() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.005)  # just fails, as is well known
    assert contrast("#767676", "#ffffff") == pytest.approx(4.54, abs=0.005)


@pytest.mark.parametrize("shade", SHADES)
def test_every_text_can_be_read(shade: str) -> None:
    pairs = texts(shade)
    assert len(pairs) > 30
    weak = {(s, a, b): round(contrast(a, b), 2) for s, a, b in pairs if contrast(a, b) < TEXT}
    assert not weak


@pytest.mark.parametrize("shade", SHADES)
def test_vehicles_and_lines_can_be_seen(shade: str) -> None:
    paper = getattr(palette.PAPER, shade)
    assert paper == variables(shade)["paper"]
    single = ("EVADER", "TARGET", "CAPTURE", "SAFETY", "FENCE", "APOLLONIUS", "CONE")
    things = {name: getattr(palette, name) for name in single}
    things |= {f"pursuer {i}": colour for i, colour in enumerate(palette.PURSUERS, 2)}
    things |= {f"action {name}": colour for name, colour in palette.ACTIONS.items()}
    ratios = {name: contrast(getattr(colour, shade), paper) for name, colour in things.items()}
    ratios |= {f"--{name}": contrast(variables(shade)[name], paper) for name in ("faint", "accent", "danger")}
    assert not {name: round(ratio, 2) for name, ratio in ratios.items() if ratio < THINGS}


@pytest.mark.parametrize("shade", SHADES)
def test_words_in_the_scene_can_be_read(shade: str) -> None:
    """They are drawn in these shades of the palette alone (static/scene.js, static/curves.js)."""
    scripts = Path(server.__file__).parent / "static"
    source = "".join((scripts / name).read_text(encoding="utf-8") for name in ("scene.js", "curves.js"))
    used = set(re.findall(r"this\.text\(pen, .*colours\.(\w+)(?: : colours\.(\w+))?\)", source))
    names = {name for pair in used for name in pair if name}
    assert "ink" in names
    paper = getattr(palette.PAPER, shade)
    ratios = {name: contrast(getattr(getattr(palette, name.upper()), shade), paper) for name in names}
    assert not {name: round(ratio, 2) for name, ratio in ratios.items() if ratio < TEXT}
