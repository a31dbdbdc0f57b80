"""The page as one file: its modules and a worker run from a disk, and nothing else does."""

from __future__ import annotations

import json
import re
from html import unescape
from pathlib import Path

import pytest
from chrome import asked, chrome, console, wait
from node import node
from pldf.cockpit.export import exported_page, write_export
from pldf.cockpit.one_script import one_script
from pldf.cockpit.page_json import as_json
from pldf.cockpit.server import PAGE
from pldf.errors import ModelError

INDEX = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>waiting</title>
<link rel="stylesheet" href="style.css">
<link rel="stylesheet" href="view/view.css">
<link rel="icon" href="icon.svg">
<script type="module" src="main.js"></script>
</head>
<body><p id="text">one</p></body>
</html>
"""
FILES = {
    "index.html": INDEX,
    "style.css": "#text { color: rgb(1, 2, 3); }",
    "view/view.css": "#text { font-weight: 900; }",
    "icon.svg": '<svg xmlns="http://www.w3.org/2000/svg"/>',
    "main.js": """import { doubled } from "./shared.js";
import {
  workerUrl,
} from "./engine/worker_url.js";
const worker = new Worker(workerUrl(), { type: "module" });
worker.onmessage = (event) => {
  const told = JSON.parse(document.getElementById("bundle").textContent);
  document.title = `${told.text} ${doubled(event.data)}`;
};
worker.postMessage(4);
""",
    "shared.js": 'export const doubled = (n) => 2 * n;\nexport const said = "from </script>";\n',
    "engine/worker_url.js": """export function workerUrl() {
  return globalThis.pldfModules["engine/worker.js"];
}
""",
    "engine/worker.js": """import { doubled } from "../shared.js";
globalThis.onmessage = (event) => postMessage(doubled(event.data));
""",
}
TEXT = "</script><script>document.title = 'hacked'</script> & <!-- ü"


@pytest.fixture
def page(tmp_path: Path) -> Path:
    folder = tmp_path / "page"
    for name, text in FILES.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def test_it_runs_from_a_disk(page: Path, tmp_path: Path) -> None:
    file = tmp_path / "cockpit.html"
    file.write_text(exported_page(as_json({"text": TEXT}), b"", page), encoding="utf-8")
    with chrome(tmp_path / "profile") as window:
        window.get(file.as_uri())
        wait(window, "document.title !== 'waiting'")
        assert window.title.startswith(TEXT[:20])
        assert window.title.endswith(" 16")
        look = "getComputedStyle(document.getElementById('text'))"
        assert window.execute_script(f"return {look}.color") == "rgb(1, 2, 3)"
        assert window.execute_script(f"return {look}.fontWeight") == "900"
        assert console(window) == []
        assert [url for url in asked(window) if url.startswith("http")] == []


@pytest.mark.parametrize("root", ["session/tables.js", "engine/profile.js", "cluster/cluster.js"])
def test_one_script_of_our_own_modules_is_one(root: str, tmp_path: Path) -> None:
    script = one_script(PAGE, root)
    assert len(re.findall(r"^// [\w/]+[.]js$", script, re.MULTILINE)) > 1
    assert not re.search(r"^(import|export)\b", script, re.MULTILINE)
    file = tmp_path / "one.mjs"
    file.write_text(script, encoding="utf-8")
    assert node("--check", str(file)).returncode == 0


SHAPES = {
    "root.js": """import only from "./a.js";
import * as all from "./b.js";
import { first, second as other, Made } from "./c.js";
import "./effect.js";
console.log(only, all.one, all.two(), first, other(), new Made().name, globalThis.effect);
""",
    "a.js": "const x = 1;export{x as default};\n",
    "b.js": 'export { first as one } from "./c.js";\nexport async function two() {}\nexport {};\n',
    "c.js": """const hidden = 7;
export const first = 'a;b';
function second() {
  return hidden;
}
export { second };
export class Made { name = "made"; }
""",
    "effect.js": "const hidden = 1;\nglobalThis.effect = hidden;\n",
}


def test_one_script_does_what_the_modules_do(tmp_path: Path) -> None:
    for name, text in SHAPES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "package.json").write_text('{"type": "module"}')
    (tmp_path / "one.mjs").write_text(one_script(tmp_path, "root.js"), encoding="utf-8")
    modules, one = (node(str(tmp_path / name)).stdout for name in ("root.js", "one.mjs"))
    assert one == modules != ""


@pytest.mark.parametrize(
    "text", ["export let x = 1;\n", "export const { x } = y;\n", "export default 1;\n"]
)
def test_what_cannot_be_put_together_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "root.js").write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=r"root.js: export"):
        one_script(tmp_path, "root.js")


@pytest.mark.parametrize("own", [True, False], ids=["small", "cockpit"])
def test_the_policy_comes_before_what_it_is_for(page: Path, own: bool) -> None:
    text = exported_page(b"{}", b"", page if own else PAGE)
    assert text.index("Content-Security-Policy") < min(map(text.index, ("<style", "<script")))
    assert "unsafe-inline" not in text
    outside = re.sub(r"(<style|<script).*?(</style>|</script>)", "", text, flags=re.DOTALL)
    assert not re.search(r'(?:href|src)="(?!data:)', outside)


def test_a_page_without_what_is_replaced_is_refused(page: Path) -> None:
    index = page / "index.html"
    index.write_text(INDEX.replace("utf-8", "latin-1"), encoding="utf-8")
    with pytest.raises(ValueError, match="charset"):
        exported_page(b"{}", b"", page)


def test_the_licences_of_all_that_is_inside_are_inside() -> None:
    text = unescape(exported_page(b"{}", b"Permission of <zig>"))
    assert "<pre>Permission of <zig>" in text
    names = [path.name for path in (PAGE / "vendor").glob("*.js")]
    assert len(names) == 3
    for name in names:
        licence = (PAGE / "vendor" / name).with_suffix(".LICENSE.txt").read_text(encoding="utf-8")
        assert licence in text


def test_the_same_page_gives_the_same_bytes(page: Path) -> None:
    assert exported_page(b"{}", b"", page) == exported_page(b"{}", b"", page)


def test_what_is_embedded_ends_no_element(page: Path) -> None:
    text = exported_page(as_json({"text": TEXT}), b"", page)
    data, script = re.findall(r"<script[^>]*>(.*?)</script>", text, re.DOTALL)
    assert json.loads(data) == {"text": TEXT}
    assert "from \\x3C/script>" in script


def test_a_place_that_cannot_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pldf.cockpit.export.exported_page", lambda *_: "page")
    with pytest.raises(ModelError, match=r"cannot be written .*--export"):
        write_export(tmp_path / "none" / "cockpit.html", b"{}")
    write_export(tmp_path / "cockpit.html", b"{}")
    assert (tmp_path / "cockpit.html").read_text() == "page"
