"""What people see on a terminal of 80 columns: of every verb its help, what it prints, and what it says when something is wrong."""

import os
import re

import pytest
from recipes import LIVE, OFFLINE, prepare, verbs
from terminal import lines_of, on_a_terminal, untidy

# Their searches take half a minute each.
SEARCHES = {"demo", "diagnose", "report", "propose"}
WORKS = [
    pytest.param(verb, words, id=" ".join(words[:3]), marks=[pytest.mark.full] if verb in SEARCHES else [])
    for verb, recipe in OFFLINE.items()
    for words in recipe.works
]
# Some words, the first of which may be the name of a machine, and a full stop.
SENTENCE = re.compile(r"\w\S*(\s+\S+){2,}?\s+\S*[^.\s]\.(\s|$)")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where the commands run: each writes files of its own."""
    if not os.environ.get("EXCAVATOR_BINARY"):
        pytest.skip("EXCAVATOR_BINARY does not say where the program is")
    place = tmp_path_factory.mktemp("terminal")
    prepare(os.environ["EXCAVATOR_BINARY"], place)
    return place


@pytest.fixture(scope="module")
def printed(folder):
    """What a command prints; each runs once."""
    kept = {}

    def ask(words):
        key = tuple(words)
        if key not in kept:
            status, kept[key] = on_a_terminal([os.environ["EXCAVATOR_BINARY"], *words], folder)
            assert status == 0, f"{words}\n{kept[key]}"
        return kept[key]

    return ask


def test_every_verb_has_a_recipe(excavator):
    """A new verb cannot be forgotten here: the program lists them, and each is live or has its recipe."""
    listed = verbs(excavator)
    assert len(listed) > 20
    assert sorted(listed) == sorted([*LIVE, *OFFLINE])


@pytest.mark.parametrize("verb", ["", *LIVE, *OFFLINE])
def test_help_fits(excavator, tmp_path, verb):
    status, output = on_a_terminal([excavator, *verb.split(), "--help"], tmp_path)
    assert status == 0 and "Usage:" in output
    assert untidy(output, of_clap=True) == []


@pytest.mark.parametrize(("verb", "words"), WORKS)
def test_output_fits(printed, verb, words):
    if OFFLINE[verb].data:
        pytest.skip(f"prints {OFFLINE[verb].data}, as it is")
    output = printed(words)
    assert len(lines_of(output)) > 1
    assert untidy(output) == []


@pytest.mark.parametrize("verb", OFFLINE)
def test_a_complaint_fits(excavator, folder, verb):
    """What is wrong is told on as many lines as it takes."""
    status, output = on_a_terminal([excavator, *OFFLINE[verb].fails], folder, complaints=True)
    assert status in (1, 2) and output.strip()
    assert untidy(output) == []


@pytest.mark.parametrize("verb", [*LIVE, *OFFLINE])
def test_a_wrong_option_is_told_in_lines_that_fit(excavator, tmp_path, verb):
    status, output = on_a_terminal([excavator, *verb.split(), "--no-such-option"], tmp_path, complaints=True)
    assert status == 2 and "--no-such-option" in output
    assert untidy(output, of_clap=True) == []


@pytest.mark.parametrize(("verb", "words"), WORKS)
def test_output_begins_with_a_sentence(printed, verb, words):
    """Before any table or list, a sentence says what came out."""
    if OFFLINE[verb].data:
        pytest.skip(f"prints {OFFLINE[verb].data}")
    text = "\n".join(lines_of(printed(words)))
    # A row of a table begins with one blank; a line that goes on under a number is indented further.
    start = re.split(r"\n\n|\n[┌│]|\n (?! )", text)[0]
    assert SENTENCE.match(start), start


@pytest.mark.parametrize(("verb", "words"), WORKS)
def test_output_ends_with_the_next_command(excavator, printed, verb, words):
    """The last thing on the screen is a command of this program, or there is a reason why there is none."""
    text = "\n".join(lines_of(printed(words))).rstrip()
    found = re.search(r"(?:^|\n)Next, [^\n]*(?:\n[^\n ][^\n]*)*:\n  excavator (\S+)(?: (\S+))?[^\n]*(?:\n      [^\n]*)*\Z", text)
    if OFFLINE[verb].data or OFFLINE[verb].last:
        assert not found, f"{verb} has a next command, and its recipe says that there is none"
        return
    assert found, text[-600:]
    known = verbs(excavator)
    assert found.group(1) in known or f"{found.group(1)} {found.group(2)}" in known
