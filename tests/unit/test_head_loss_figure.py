"""Head loss of a run beside the correlations: the right point, before the right curves."""

import numpy as np
import pytest
from synthetic_results import CASE, TIMES, frame, open_writer

from mpsdem.analysis import survey
from mpsdem.analysis.head_loss import DHLLDV, MODELS, comparable, measured
from mpsdem.plot import draw_head_loss, figures
from mpsdem.results import Results, ResultsError, write_summary
from mpsdem.results.summary import SUMMARY_KEYS

PER_METRE = 1000.0 * 9.807  # Pa/m of a metre of water per metre
SHARE = 64 * 4 / 3 * 0.01**3 / (0.1**2 * 4.0)  # of 64 spheres of 20 mm in 4 m of 200 mm


def write(directory, *, velocity=1.0, gradient=120.0, case=CASE):
    """A made-up run whose first half is not steady; its solids go at half the bulk velocity."""
    with open_writer(directory, case) as writer:
        for time in TIMES:
            one = frame(time, case)
            one["diagnostics"] |= {
                "bulk_velocity": velocity,
                "solids_mean_velocity": velocity / 2,
                "pressure_gradient": gradient + (500.0 if time < 3.9 else np.sin(40 * time)),
            }
            writer.append(time, **one)
    summary = dict.fromkeys(SUMMARY_KEYS) | {"status": "finished", "time": TIMES[-1]}
    write_summary(directory, summary)
    return Results(directory)


def points_of(figure):
    (bars,) = figure.axes[0].containers
    return bars[0].get_xdata(), bars[0].get_ydata()


def test_a_run_is_read_as_the_models_ask_for_it(tmp_path):
    run = measured(write(tmp_path, velocity=2.0, gradient=300.0))
    assert run.flow.concentration == pytest.approx(SHARE)
    assert run.delivered == pytest.approx(SHARE / 2)
    assert run.gradient == pytest.approx(300.0, abs=1.0)
    assert 0 < run.error < 1.0
    assert (run.flow.diameter, run.flow.bulk_velocity) == (pytest.approx(0.02), 2.0)


def test_the_point_stands_at_the_mean_of_the_second_half(tmp_path):
    velocity, head = points_of(draw_head_loss([write(tmp_path)]))
    assert velocity == pytest.approx([1.0])
    assert head == pytest.approx([120.0 / PER_METRE], rel=0.01)


def test_the_curve_of_the_framework_goes_through_what_it_says_of_the_run(tmp_path):
    results = write(tmp_path)
    (axes,) = draw_head_loss([results]).axes
    (curve,) = (line for line in axes.lines if str(line.get_label()).startswith("DHLLDV"))
    expected = DHLLDV.gradient(measured(results).flow) / PER_METRE
    assert np.interp(1.0, *curve.get_data()) == pytest.approx(expected, rel=1e-3)


def test_where_a_model_does_not_hold_its_curve_is_dotted(tmp_path):
    """64 nodules are a delivered share of 0.001: less than Durand measured."""
    (axes,) = draw_head_loss([write(tmp_path)]).axes
    (curve,) = (line for line in axes.lines if str(line.get_label()).startswith("Durand"))
    assert curve.is_dashed()
    legend = axes.get_legend().get_texts()
    assert len(legend) == len(MODELS) + 2


def test_several_velocities_make_a_sweep(tmp_path):
    runs = [write(tmp_path / f"{u}", velocity=u, gradient=100 * u) for u in (3.0, 1.0, 2.0)]
    velocity, head = points_of(draw_head_loss(runs))
    assert velocity == pytest.approx([1.0, 2.0, 3.0])
    assert (np.diff(head) > 0).all()


def test_runs_of_other_solids_do_not_go_into_one_figure(tmp_path):
    heavy = CASE.with_(solids={"density": 3000.0})
    runs = [write(tmp_path / "a"), write(tmp_path / "b", case=heavy)]
    with pytest.raises(ResultsError, match="differ in density, 2700 and 3000"):
        draw_head_loss(runs)


def test_a_pipe_that_rises_says_so(tmp_path):
    rising = CASE.with_(pipe={"inclination": np.radians(30)})
    (axes,) = draw_head_loss([write(tmp_path, case=rising)]).axes
    assert "pipe rises by 30 deg" in axes.get_title(loc="left")
    (curve,) = (line for line in axes.lines if str(line.get_label()).startswith("DHLLDV"))
    level = draw_head_loss([write(tmp_path / "level")]).axes[0]
    (flat,) = (line for line in level.lines if str(line.get_label()).startswith("DHLLDV"))
    assert curve.get_ydata()[0] > flat.get_ydata()[0]  # the solids are lifted


@pytest.mark.parametrize(
    "change", [{"solids": {"density": 900.0}}, {"gravity": 0.0}, {"solids": {"held": True}}]
)
def test_what_does_not_settle_has_no_figure_of_head_loss(tmp_path, change):
    results = write(tmp_path, case=CASE.with_(**change))
    assert not comparable(results)
    with pytest.raises(ResultsError, match="solids heavier than a liquid"):
        draw_head_loss([results])


def test_the_figure_is_among_those_of_a_run(tmp_path):
    results = write(tmp_path)
    assert "head_loss" in dict(figures._drawings(results, None, survey(results)))
