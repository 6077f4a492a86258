#!/usr/bin/env python3
"""Makes a page with live figures: reads HTML from standard input and writes a page.

Each paragraph that begins with "Try:" gets a figure that does what the paragraph says: the step of the
tour or the example that it names, embedded as docs/web.md describes.
"""

import re
import sys

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
  body {{ max-width: 46rem; margin: 2rem auto; padding: 0 1rem; font: 18px/1.6 serif; color: #222; }}
  h1, h2, h3 {{ font-family: system-ui, sans-serif; line-height: 1.25; }}
  iframe {{ width: 100%; height: 380px; border: 0; border-radius: 8px; background: #202228; }}
  img {{ max-width: 100%; border-radius: 8px; }}
  pre, code {{ font-size: 15px; overflow-x: auto; }}
  table {{ border-collapse: collapse; font-size: 16px; }}
  td, th {{ border-bottom: 1px solid #ccc; padding: .2rem .6rem; text-align: left; vertical-align: top; }}
</style>
</head>
<body>
{body}
</body>
</html>
"""

# What a step of the tour is about, beside the view.
PARTS = {
    2: "hand", 3: "hand,triangle", 4: "twist,guides", 5: "guides,triangle", 6: "hand",
    7: "hand,triangle", 8: "twist,guides", 9: "hand",
}
EXAMPLES = {"Why not?": "out-of-reach", "Jumping chain": "jumping-chain"}


def figure(paragraph):
    """The figure of a paragraph that begins with "Try:"; the paragraph alone if it names none."""
    step = re.search(r"steps? (?:1 and )?(\d+) of the tour", paragraph)
    example = next((name for title, name in EXAMPLES.items() if title in paragraph), None)
    if step:
        number = int(step[1])
        parts, link = PARTS.get(number, ""), f"tour={number}"
    elif example:
        parts, link = "", f"example={example}"
    else:
        return paragraph
    shown = ",".join(filter(None, ["view", parts]))
    frame = f'<iframe loading="lazy" src="./?embed={shown}#{link}" title="A live figure"></iframe>'
    return f"{paragraph}\n{frame}"


def main():
    body = sys.stdin.read()
    body = re.sub(r"<p><em>Try:.*?</p>", lambda found: figure(found[0]), body, flags=re.S)
    # Other texts of the project are not part of the page.
    body = re.sub(r'<a href="[^"#:]*\.md[^"]*">(.*?)</a>', r"\1", body, flags=re.S)
    title = re.search(r"<h1>(.*?)</h1>", body)
    sys.stdout.write(PAGE.format(title=title[1] if title else "ik-arm", body=body))


if __name__ == "__main__":
    main()
