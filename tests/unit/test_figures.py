"""Figures show what was computed: true sizes, true places, one colour scale, units on the axes."""

import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection
from matplotlib.image import imread
from matplotlib.patches import Circle
from synthetic_results import CASE, CLEAR, TIMES, cluster, frame, open_writer, write_run

from mpsdem import plot
from mpsdem.plot import save_figures
from mpsdem.results import OutputError, Results, ResultsError

FIGURES = [
    plot.side_view,
    plot.cross_sections,
    plot.silhouettes,
    plot.positions_over_time,
    plot.solids_velocity_over_height,
    plot.solids_fraction_over_height,
    plot.pressure_gradient_over_time,
]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return Results(write_run(tmp_path_factory.mktemp("run")))


def drawn_spheres(axes):
    return [item for item in axes.collections if isinstance(item, EllipseCollection)]


def with_spheres(figure):
    return [axes for axes in figure.axes if drawn_spheres(axes)]


def test_a_run_gets_all_its_figures(results, tmp_path):
    paths = save_figures(results, tmp_path / "Bilder – 図")
    assert {path.stem for path in paths} == {
        "side_view",
        "cross_sections",
        "silhouette",
        "position",
        "velocity",
        "volume_fraction",
        "pressure_gradient",
    }
    for path in paths:
        height, width, _ = imread(path).shape
        assert width > 1000, path
        assert height > 400, path


def test_clear_liquid_gets_the_figures_of_the_liquid(tmp_path):
    results = Results(write_run(tmp_path, CLEAR))
    paths = save_figures(results, tmp_path / "figures")
    assert {path.stem for path in paths} == {"velocity", "pressure_gradient"}
    with pytest.raises(ResultsError, match="no solids"):
        plot.side_view(results)


def test_a_run_of_one_frame_is_drawn(tmp_path):
    results = Results(write_run(tmp_path, times=TIMES[:1]))
    assert len(save_figures(results, tmp_path / "figures")) == 7


def test_the_side_view_shows_each_solid_where_it_is_and_as_large_as_it_is(results):
    strips = with_spheres(plot.side_view(results, times=[0.0, 8.0]))
    assert len(strips) == 2
    (spheres,) = drawn_spheres(strips[0])
    assert spheres._units == "xy"
    np.testing.assert_allclose(spheres.get_widths(), 0.02)
    np.testing.assert_allclose(spheres.get_heights(), 0.02)
    shown = np.asarray(spheres.get_offsets())
    np.testing.assert_allclose(np.sort(shown, axis=0), np.sort(cluster(0.0)[0][:, [0, 2]], axis=0))
    size = strips[0].get_window_extent()
    across, up = np.ptp(strips[0].get_xlim()), np.ptp(strips[0].get_ylim())
    assert size.width / across == pytest.approx(size.height / up, rel=0.05)


def test_near_solids_hide_far_ones(tmp_path):
    fields = frame(0.0)
    position = fields["solids"]["position"]
    position[:, 0] += 2 * position[:, 1]  # so that x tells the depth
    with open_writer(tmp_path) as writer:
        writer.append(0.0, **fields)
    (spheres,) = drawn_spheres(with_spheres(plot.side_view(Results(tmp_path)))[0])
    last_drawn, nearest = np.asarray(spheres.get_offsets())[-16:], position[:, 1] < -0.03
    assert nearest.sum() == 16
    assert set(last_drawn[:, 0]) == set(position[nearest, 0])


def test_a_solid_in_the_outlet_is_seen_at_the_inlet_too(tmp_path):
    fields = frame(0.0)
    fields["solids"]["position"][0] = [CASE.pipe.length - 0.004, 0.0, 0.05]
    with open_writer(tmp_path) as writer:
        writer.append(0.0, **fields)
    (spheres,) = drawn_spheres(with_spheres(plot.side_view(Results(tmp_path)))[0])
    twice = np.asarray(spheres.get_offsets())[:, 1] == 0.05
    np.testing.assert_allclose(np.sort(spheres.get_offsets()[twice, 0]), [-0.004, 3.996])


@pytest.mark.parametrize("draw", [plot.side_view, plot.cross_sections])
def test_colours_run_from_rest_to_the_bulk_velocity(results, draw):
    figure = draw(results, times=[0.0, 8.0])
    for axes in with_spheres(figure):
        assert drawn_spheres(axes)[0].get_clim() == (0.0, CASE.liquid.bulk_velocity)
    assert any("speed" in axes.get_ylabel() for axes in figure.axes)


def test_sections_are_round_with_the_bore_around_them(results):
    sections = with_spheres(plot.cross_sections(results, times=[2.0]))
    assert len(sections) == 3
    for axes in sections:
        assert axes.get_aspect() == 1.0
        assert [p.radius for p in axes.patches if isinstance(p, Circle)] == [CASE.pipe.radius]
        (spheres,) = drawn_spheres(axes)
        np.testing.assert_allclose(spheres.get_widths(), 0.02)
        assert (np.hypot(*np.asarray(spheres.get_offsets()).T) < CASE.pipe.radius).all()


def test_the_front_section_shows_the_front(results):
    front, _, tail = with_spheres(plot.cross_sections(results, times=[8.0]))
    speeds = [drawn_spheres(axes)[0].get_array() for axes in (front, tail)]
    assert speeds[0].min() > 0.65
    assert speeds[1].max() < 0.55


def test_figures_take_the_frames_nearest_to_the_times(results):
    texts = {t.get_text() for axes in plot.side_view(results, [0.2, 3.9]).axes for t in axes.texts}
    assert texts == {"0 s", "4 s"}
    assert len(with_spheres(plot.side_view(results, times=[7.9, 8.0, 99.0]))) == 1


@pytest.mark.parametrize("draw", FIGURES, ids=lambda draw: draw.__name__)
def test_every_labelled_axis_has_its_unit(results, draw):
    labels = [
        label
        for axes in draw(results).axes
        for label in (axes.get_xlabel(), axes.get_ylabel())
        if label
    ]
    assert len(labels) >= 2
    assert all(label.endswith(")") for label in labels), labels


def test_the_position_of_a_cluster_is_that_of_its_solids(results):
    (axes,) = plot.positions_over_time(results).axes
    curves = {line.get_label().split()[0]: line for line in axes.lines}
    assert curves["centre"].get_ydata()[-1] == pytest.approx(np.median(cluster(8.0)[0][:, 0]))
    assert (curves["front"].get_ydata() > curves["centre"].get_ydata()).all()
    assert (curves["tail"].get_ydata() < curves["centre"].get_ydata()).all()


def test_a_start_up_peak_does_not_flatten_the_pressure_loss_after_it(tmp_path):
    with open_writer(tmp_path, CLEAR) as writer:
        for time in np.linspace(0.0, 8.0, 100):
            loss = 3000.0 if time == 0 else 60.0 + np.sin(time)
            writer.append(time, diagnostics={"pressure_gradient": loss})
    (axes,) = plot.pressure_gradient_over_time(Results(tmp_path)).axes
    bottom, top = axes.get_ylim()
    assert 55 < bottom < 59 < 61 < top < 65
    assert any("3000" in text.get_text() for text in axes.texts)


def test_drawing_changes_no_settings_and_needs_no_display(results):
    before = dict(mpl.rcParams)
    plot.side_view(results)
    assert dict(mpl.rcParams) == before
    script = "import sys, mpsdem.plot; assert 'matplotlib.pyplot' not in sys.modules"
    subprocess.run([sys.executable, "-c", script], check=True)


def test_figures_that_cannot_be_written_are_an_error_in_words(results, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(OutputError, match="not a directory"):
        save_figures(results, tmp_path / "file" / "figures")
