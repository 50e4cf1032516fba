"""The pages of docs/ as a site: built without a warning, every page in it, and no link, picture or heading that leads nowhere."""

from __future__ import annotations

import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from daemon.cli.program import COMMANDS

ROOT = Path(__file__).parent.parent.parent
DOCS, SETTINGS = ROOT / "docs", ROOT / "docs/tools/mkdocs.yml"
PAGES = sorted(str(page.relative_to(DOCS)) for page in DOCS.rglob("*.md"))


class Links(HTMLParser):
    """What a page leads to, and the places in it that others may lead to."""

    def __init__(self, page: Path) -> None:
        super().__init__()
        self.to: list[str] = []
        self.places: set[str] = set()
        self.feed(page.read_text("utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self.places |= {values[name] for name in ("id", "name") if name in values}
        self.to += [values[name] for name in ("href", "src") if name in values]


def build(folder: Path, settings: Path = SETTINGS) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "-f", str(settings), "-d", str(folder)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    done = build(folder)
    assert done.returncode == 0, done.stderr
    return folder


def html(site: Path, page: str) -> Path:
    """The built page; a README is the index of its folder."""
    path = site / page
    return path.with_name("index.html") if path.name == "README.md" else path.with_suffix(".html")


def leads_nowhere(site: Path, page: Path) -> list[str]:
    """The links of a built page that stay in the site and end nowhere."""
    missing: list[str] = []
    for link in Links(page).to:
        parts = urlsplit(link)
        if parts.scheme or parts.netloc:
            continue
        target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
        if target.is_dir():
            target /= "index.html"
        here = target.is_file() and (not parts.fragment or unquote(parts.fragment) in Links(target).places)
        if not (here or (target.is_file() and target.suffix != ".html")):
            missing.append(link)
    return missing


@pytest.mark.long
@pytest.mark.parametrize("page", PAGES)
def test_a_page_is_in_the_site_and_its_links_lead_somewhere(page, site):
    built = html(site, page)
    assert built.is_file()
    assert leads_nowhere(site, built) == []


@pytest.mark.long
def test_the_first_page_leads_to_every_part_of_the_site(site):
    index = Links(site / "index.html").to
    reached = {
        str((site / unquote(urlsplit(link).path)).relative_to(site)) for link in index if not urlsplit(link).scheme
    }
    assert {str(html(site, page).relative_to(site)) for page in PAGES} - {"index.html"} <= reached


@pytest.mark.long
def test_every_command_is_in_the_site_with_its_options(site):
    page = Links(site / "commands.html")
    assert {f"mmmd-{name}" for name in COMMANDS} <= page.places
    said = (site / "commands.html").read_text("utf-8")
    assert all(option in said for option in ("--sides", "--estop", "--tempo", "--robot"))
    assert leads_nowhere(site, site / "commands.html") == []


def test_a_wrong_link_and_a_page_left_out_are_found(tmp_path):
    """Neither check passes whatever it is given."""
    folder = tmp_path / "docs"
    folder.mkdir()
    (tmp_path / "settings").mkdir()
    (folder / "index.md").write_text("# Here\n\n[gone](gone.md) [nowhere](#nowhere)\n")
    (folder / "left_out.md").write_text("# Left out\n")
    text = SETTINGS.read_text("utf-8").partition("nav:\n  - Begin")[0].replace("docs_dir: ..", "docs_dir: ../docs")
    settings = tmp_path / "settings/mkdocs.yml"
    settings.write_text(text + "nav: [index.md]\n")
    done = build(tmp_path / "site", settings)
    assert done.returncode != 0
    for found in ("gone.md", "#nowhere", "left_out.md"):
        assert found in done.stderr, done.stderr
    page = tmp_path / "page.html"
    page.write_text('<a href="gone.html">x</a><a href="#nowhere">x</a><p id="here"><a href="#here">x</a>')
    assert leads_nowhere(tmp_path, page) == ["gone.html", "#nowhere"]
