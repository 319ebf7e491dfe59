"""Figures show what was computed: true sizes, true places, one colour scale, units on the axes."""

import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.patches import Circle
from synthetic_results import (
    CASE,
    CLEAR,
    FRICTION_VELOCITY,
    HEIGHTS,
    LAMINAR,
    TIMES,
    blank,
    cluster,
    frame,
    mean_velocity,
    open_writer,
    write_run,
)

from mpsdem import plot
from mpsdem.case import Case
from mpsdem.plot import save_figures
from mpsdem.results import OutputError, Results, ResultsError

FIGURES = [
    plot.side_view,
    plot.cross_sections,
    plot.silhouettes,
    plot.positions_over_time,
    plot.velocities,
    plot.solids_fraction,
    plot.velocity_distribution,
    plot.transport_history,
    plot.along_the_pipe,
    plot.pressure_gradient_over_time,
]
LIQUID_FIGURES = [
    plot.liquid_sections,
    plot.liquid_middle_plane,
    plot.liquid_velocity_profile,
    plot.pressure_along_axis,
    plot.solver_history,
]
DRY = Case(**CASE.model_dump(exclude={"liquid"}))
MEANS = {"liquid_profile", "liquid_pressure", "liquid_solver"}
PICTURES = {"liquid_sections", "liquid_middle_plane"}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return Results(write_run(tmp_path_factory.mktemp("run")))


@pytest.fixture(scope="module")
def particles(tmp_path_factory):
    """A run of clear liquid whose particles were recorded."""
    return Results(write_run(tmp_path_factory.mktemp("run"), CLEAR, liquid="particles"))


@pytest.fixture
def blank_figures(monkeypatch):
    """Make files of figures without drawing what is in them, which takes seconds."""
    monkeypatch.setattr(Figure, "savefig", blank)


def with_picture(figure):
    return [axes for axes in figure.axes if axes.images]


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
        "velocity_distribution",
        "transport",
        "along_pipe",
        "pressure_gradient",
    }
    for path in paths:
        height, width, _ = imread(path).shape
        assert width > 1000, path
        assert height > 400, path


@pytest.mark.usefixtures("blank_figures")
def test_clear_liquid_gets_the_figures_of_the_liquid(tmp_path):
    results = Results(write_run(tmp_path, CLEAR))
    paths = save_figures(results, tmp_path / "figures")
    assert {path.stem for path in paths} == {"velocity", "pressure_gradient"}
    with pytest.raises(ResultsError, match="no solids"):
        plot.side_view(results)


@pytest.mark.parametrize(
    ("liquid", "of_liquid"),
    [("prescribed", set()), ("particles", MEANS | PICTURES), ("unrecorded", MEANS)],
)
@pytest.mark.parametrize("case", [CASE, CLEAR], ids=["solids", "clear"])
@pytest.mark.usefixtures("blank_figures")
def test_a_run_of_one_frame_is_drawn(tmp_path, case, liquid, of_liquid):
    results = Results(write_run(tmp_path, case, TIMES[:1], liquid))
    drawn = {path.stem for path in save_figures(results, tmp_path / "figures")}
    assert {stem for stem in drawn if stem.startswith("liquid")} == of_liquid
    assert len(drawn - of_liquid) == (2 if case is CLEAR else 10)


@pytest.mark.usefixtures("blank_figures")
def test_a_dry_run_is_drawn(tmp_path):
    with open_writer(tmp_path, DRY) as writer:
        writer.append(0.0, solids=frame(0.0)["solids"], diagnostics={"contacts": 3})
    drawn = {path.stem for path in save_figures(Results(tmp_path), tmp_path / "figures")}
    assert "velocity" in drawn
    assert "pressure_gradient" not in drawn
    assert not any(stem.startswith("liquid") for stem in drawn)


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


@pytest.mark.parametrize("draw", FIGURES + LIQUID_FIGURES, ids=lambda draw: draw.__name__)
def test_every_labelled_axis_has_its_unit(results, particles, draw):
    labels = [
        label
        for axes in draw(particles if draw in LIQUID_FIGURES else results).axes
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


def test_sections_of_the_liquid_are_fast_inside_slow_outside_and_cut_at_the_bore(particles):
    figure = plot.liquid_sections(particles, times=[0.0, 8.0])
    pictures = with_picture(figure)
    assert len(pictures) == 4
    for axes in pictures:
        assert axes.get_aspect() == 1.0
        assert {p.radius for p in axes.patches} == {CASE.pipe.radius}
        assert axes.images[0].get_clip_path() is not None
    velocity, pressure = (axes.images[0].get_array() for axes in (pictures[0], pictures[2]))
    n = velocity.shape[0]
    ring = np.hypot(*(np.indices(velocity.shape) - (n - 1) / 2)) / (n / 2 / 1.03)
    assert velocity[ring < 0.3].mean() > 1.2 * velocity[(ring > 0.9) & (ring < 1)].mean()
    assert velocity[ring < 1].min() > 0.1  # the particles of the wall are at rest
    assert abs(pressure[ring < 1].mean()) < 1.0  # not the 200 Pa that all have in common


def test_times_of_a_section_share_their_colours(particles):
    first, second, *_ = with_picture(plot.liquid_sections(particles, times=[0.0, 8.0]))
    assert first.images[0].get_clim() == second.images[0].get_clim()


def test_the_middle_plane_shows_what_goes_where(tmp_path):
    fields = frame(0.0, CLEAR, "particles")
    position, velocity = fields["liquid"]["position"], fields["liquid"]["velocity"]
    velocity[:, 0] = np.where((position[:, 0] > 3.0) & (position[:, 2] > 0), 2.0, 1.0)
    velocity[np.abs(position[:, 1]) > 0.05, 0] = 9.0  # far from the plane
    with open_writer(tmp_path, CLEAR, "particles") as writer:
        writer.append(0.0, **fields)
    (axes,) = with_picture(plot.liquid_middle_plane(Results(tmp_path)))
    picture = axes.images[0].get_array()
    rows, columns = picture.shape
    right = slice(columns * 4 // 5, None)
    assert (picture[:, : columns * 7 // 10] == 1.0).all()
    assert (picture[rows * 7 // 10 :, right] == 2.0).all()
    assert (picture[: rows * 3 // 10, right] == 1.0).all()


def test_pictures_of_a_liquid_that_was_not_recorded_are_refused(tmp_path):
    results = Results(write_run(tmp_path, CLEAR, TIMES[:1], "unrecorded"))
    with pytest.raises(ResultsError, match="recorded no particles"):
        plot.liquid_sections(results)
    prescribed = Results(write_run(tmp_path / "prescribed", CLEAR, TIMES[:1]))
    with pytest.raises(ResultsError, match="no liquid that is computed"):
        plot.solver_history(prescribed)


def curve(axes, label):
    (line,) = [line for line in axes.lines if label in line.get_label()]
    return line.get_xdata(), line.get_ydata()


@pytest.mark.parametrize("case", [CLEAR, LAMINAR], ids=["log law", "parabola"])
def test_a_profile_that_obeys_its_law_lies_on_it(tmp_path, case, request):
    results = Results(write_run(tmp_path, case, liquid="particles"))
    axes, *wall_units = plot.liquid_velocity_profile(results).axes
    r, law = curve(axes, request.node.callspec.id)
    inner = r < 0.95 * case.pipe.radius
    np.testing.assert_allclose(law[inner], mean_velocity(r, case)[inner], rtol=2e-3)
    assert law[-1] == 0
    r, mean = curve(axes, "mean")
    assert len(r) == 19  # the ring round the axis is empty
    np.testing.assert_allclose(mean, mean_velocity(r, case), rtol=0.01)
    assert len(wall_units) == (case is CLEAR)


def test_wall_units_are_those_of_the_friction(particles):
    _, axes = plot.liquid_velocity_profile(particles).axes
    y_plus, u_plus = curve(axes, "liquid")
    np.testing.assert_allclose(y_plus.max(), FRICTION_VELOCITY * 0.0975 / 1e-6, rtol=0.05)
    np.testing.assert_allclose(u_plus[-1], 5.2 + np.log(y_plus[-1]) / 0.41, rtol=0.02)


def test_drag_on_solids_is_no_friction_of_the_wall(tmp_path):
    drag = 1000.0  # [N] on all solids
    loss = drag / (np.pi * CASE.pipe.radius**2 * CASE.pipe.length)
    with open_writer(tmp_path, liquid="particles") as writer:
        fields = frame(0.0, CASE, "particles")
        fields["diagnostics"]["pressure_gradient_solids"] = loss
        fields["diagnostics"]["pressure_gradient"] += loss
        writer.append(0.0, **fields)
    labels = plot.liquid_velocity_profile(Results(tmp_path)).axes[0].get_legend().get_texts()
    assert any(f"u* = {FRICTION_VELOCITY:.3g} m/s" in text.get_text() for text in labels)


def test_the_pressure_falls_along_the_pipe_by_its_mean_gradient(particles):
    above, below = plot.pressure_along_axis(particles, times=[8.0]).axes
    x, p = above.lines[0].get_data()
    assert (p[-1] - p[0]) / (x[-1] - x[0]) == pytest.approx(
        -particles.pressure_gradient[-1], rel=0.02
    )
    assert np.abs(below.lines[0].get_ydata()).max() <= 2.0


def test_the_solver_history_leaves_out_what_no_step_has_made_yet(particles):
    axes = {a.get_ylabel().split("\n")[0]: a for a in plot.solver_history(particles).axes}
    assert axes["iterations"].lines[0].get_xdata()[0] == TIMES[1]
    assert axes["scatter of the"].lines[0].get_xdata()[0] == 0
    assert axes["largest"].get_yscale() == "log"
    cut, held = axes["since the last"].lines
    assert cut.get_ydata().sum() == 1
    assert held.get_ydata().max() == 3


def test_a_computed_liquid_has_its_own_velocity_at_every_height_and_time(tmp_path):
    results = Results(write_run(tmp_path, CASE, liquid="particles"))
    of_solids, of_liquid, over_radius = plot.velocities(results, [0.0, 8.0]).axes
    dashed = [line for line in of_liquid.lines if line.get_linestyle() == "--"]
    assert [line.get_label() for line in dashed] == ["0 s", "8 s"]
    for line in dashed:
        np.testing.assert_allclose(line.get_ydata(), 0.1 * (1 + HEIGHTS))
        np.testing.assert_allclose(line.get_xdata(), 1 + 0.1 * HEIGHTS)
    drawn = {line.get_label() for line in of_solids.lines}
    assert drawn >= {"0 s", "8 s"}
    r, u = curve(over_radius, "liquid")
    np.testing.assert_allclose(u, mean_velocity(r, CASE), rtol=0.02)


def test_the_section_map_is_dark_where_the_solids_are(results):
    section = plot.solids_fraction(results).axes[2]
    (picture,) = section.collections
    fraction = picture.get_array()  # rows go up
    rows, columns = np.nonzero(fraction.filled(0) > 0.5 * fraction.max())
    edges = np.linspace(-0.1, 0.1, fraction.shape[0] + 1)
    assert edges[rows.min()] >= -0.062 - 0.01
    assert edges[rows.max() + 1] <= 0.025 + 0.01  # cluster: z from -0.06 to 0.023 m
    assert np.abs(edges[[columns.min(), columns.max() + 1]]).max() <= 0.0415 + 0.01
    assert section.get_aspect() == 1.0


def test_a_cluster_is_a_band_whose_slope_is_its_speed(tmp_path):
    with open_writer(tmp_path) as writer:
        for time in np.linspace(0.0, 2.0, 21):
            fields = frame(0.0)
            fields["solids"]["position"][:, 0] = np.linspace(0.5, 1.5, 64) + 0.5 * time
            writer.append(time, **fields)
    picture = plot.along_the_pipe(Results(tmp_path)).axes[0].collections[0]
    fraction = np.asarray(picture.get_array())
    station = (np.arange(fraction.shape[1]) + 0.5) * CASE.pipe.length / fraction.shape[1]
    centre = fraction @ station / fraction.sum(axis=1)
    np.testing.assert_allclose(centre - centre[0], 0.5 * np.linspace(0.0, 2.0, 21), atol=5e-3)


def test_peaks_of_the_pressure_loss_are_marked_where_the_pipe_is_shaken(tmp_path):
    shake = {"vibration": {"direction": "y", "amplitude": 0.01, "period": 2.0}}
    shaken = Case(**CLEAR.model_dump() | {"motion": shake})
    with open_writer(tmp_path, shaken) as writer:
        for time in np.linspace(0.0, 8.0, 81):
            loss = 80.0 + 10.0 * np.sin(np.pi * time)
            writer.append(time, diagnostics={"pressure_gradient": loss})
    (axes,) = plot.pressure_gradient_over_time(Results(tmp_path)).axes
    lines = {line.get_label(): line.get_ydata() for line in axes.lines}
    np.testing.assert_allclose(lines["peaks"], [90.0, 90.0], rtol=1e-3)
    np.testing.assert_allclose(lines["means of\nthe periods"], [80.0, 80.0], rtol=1e-9)


def test_the_loss_of_pressure_is_drawn_with_its_parts(tmp_path):
    with open_writer(tmp_path) as writer:
        for time in TIMES:
            fields = frame(time)
            parts = {"pressure_gradient_friction": 50.0, "pressure_gradient_solids": 30.0 + time}
            fields["diagnostics"] |= parts
            writer.append(time, **fields)
    (axes,) = plot.pressure_gradient_over_time(Results(tmp_path)).axes
    lines = {line.get_label(): line.get_ydata() for line in axes.lines}
    assert np.all(lines["of the walls"] == 50.0)
    np.testing.assert_allclose(lines["of the solids"], 30.0 + TIMES[1:])
    low, high = axes.get_ylim()
    assert low < 30.0
    assert high > 80.0


def test_a_section_of_the_liquid_cuts_the_solids_that_lie_in_it(tmp_path):
    results = Results(write_run(tmp_path, CASE, liquid="particles"))
    cut = plot.liquid_sections(results, [0.0]).axes[0]
    (outlines,) = drawn_spheres(cut)
    x = results.solids.position[0, :, 0]
    here = np.abs(x - 2.0) < 0.01
    assert len(outlines.get_offsets()) == here.sum() == 16
    np.testing.assert_allclose(outlines.get_widths(), 0.02)


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
