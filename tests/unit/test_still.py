"""The picture in three dimensions shows the solids where most of them are, and never does harm."""

import logging

import numpy as np
import pytest
from matplotlib import colormaps
from synthetic_results import CASE, CLEAR, TIMES, frame, open_writer, write_run

from mpsdem.plot import render, save_still, still, still_picture
from mpsdem.plot.still import RenderError, _disc, _piece
from mpsdem.results import Results

LENGTH, DIAMETER = 4.0, 0.2


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return Results(write_run(tmp_path_factory.mktemp("run"), CASE, TIMES[:1]))


@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize("middle", [0.1, 1.7, 3.95])
def test_the_piece_holds_most_of_the_solids_and_is_no_longer_than_it_must(middle, periodic):
    rng = np.random.default_rng(0)
    x = np.concatenate([middle + rng.uniform(-0.3, 0.3, 90), rng.uniform(0, LENGTH, 10)])
    x = np.remainder(x, LENGTH) if periodic else np.clip(x, 0, LENGTH - 1e-6)
    piece = _piece(x, DIAMETER, LENGTH, periodic=periodic)
    assert np.count_nonzero(np.abs(piece.from_its_middle(x)) <= piece.length / 2) >= 80
    assert piece.length <= 0.6 + DIAMETER / 2
    if not periodic:
        assert 0 <= piece.start <= piece.start + piece.length <= LENGTH


def test_solids_all_along_the_pipe_are_shown_in_a_part_of_it():
    piece = _piece(np.linspace(0, LENGTH, 500, endpoint=False), DIAMETER, LENGTH, periodic=True)
    assert piece.length == pytest.approx(6 * DIAMETER)
    short = _piece(np.array([0.2]), DIAMETER, 0.4, periodic=True)
    assert (short.start, short.length) == (0.0, 0.4)


def test_the_disc_has_the_velocity_of_the_liquid_at_the_end_of_the_piece(tmp_path, results):
    piece = _piece(np.array([3.9]), DIAMETER, LENGTH, periodic=True)
    points, prescribed = _disc(results, 0, piece)
    assert (points[..., 0] == piece.length / 2).all()
    np.testing.assert_allclose(prescribed[0], results.liquid.profile_velocity[0])
    assert np.abs(prescribed[-1]).max() < 1e-6
    fields = frame(0.0, liquid="particles")
    x = fields["liquid"]["position"][:, 0]
    fields["liquid"]["velocity"][:, 0] = x  # so that the velocity tells the place
    with open_writer(tmp_path, liquid="particles") as writer:
        writer.append(0.0, **fields)
    end = (piece.start + piece.length) % LENGTH
    velocity = _disc(Results(tmp_path), 0, piece)[1]
    assert np.abs(velocity - end).mean() < 0.05


def test_the_picture_shows_the_speeds_in_a_pipe_that_rises(tmp_path):
    pytest.importorskip("pyvista")
    rising = CASE.with_(pipe={"inclination": "60 deg"})
    try:
        figure = still_picture(Results(write_run(tmp_path, rising, TIMES[:1])), 0.0)
    except RenderError as reason:
        pytest.skip(str(reason))
    (axes,) = (axes for axes in figure.axes if axes.images)
    assert "0.6 m of the pipe" in axes.get_title(loc="left")
    picture = np.asarray(axes.images[0].get_array(), dtype=float)
    height, width, _ = picture.shape
    assert height > max(width, 1200)
    rows = [
        np.flatnonzero((part < 250).any(axis=(1, 2))).mean()
        for part in np.array_split(picture, 3, axis=1)
    ]
    assert rows[0] > rows[1] > rows[2]  # counted from above

    middle = picture[height // 3 : -height // 3]  # neither the disc nor the edges
    brightest, darkest = middle.max(axis=2), middle.min(axis=2)
    hue = (middle - darkest[..., None])[darkest < 0.7 * brightest]
    scale = colormaps["viridis"](np.linspace(0, 1, 50))[:, :3]
    hues = scale - scale.min(axis=1, keepdims=True)
    hue, hues = (h / h.max(axis=1, keepdims=True) for h in (hue, hues))
    nearest = np.abs(hue[:, None] - hues).sum(axis=2).argmin(axis=1) / 49
    assert len(hue) > 5000
    assert 0.4 / 1.2 < np.median(nearest) < 0.76 / 1.2  # their speeds over the liquid's fastest


def test_a_machine_that_cannot_draw_gets_a_line_in_the_log(results, tmp_path, monkeypatch, caplog):
    crashing = tmp_path / "crashing.py"
    crashing.write_text("import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)")
    monkeypatch.setattr(render, "__file__", str(crashing))
    with caplog.at_level(logging.WARNING):
        assert save_still(results, tmp_path) == []
        monkeypatch.setattr(still, "find_spec", lambda _: None)
        assert save_still(results, tmp_path) == []
    drawing, installing = caplog.messages
    assert "OpenGL" in drawing
    assert "pip install pyvista" in installing
    assert list(tmp_path.glob("*.png")) == []


def test_clear_liquid_has_no_still(tmp_path):
    assert save_still(Results(write_run(tmp_path, CLEAR, TIMES[:1])), tmp_path) == []
