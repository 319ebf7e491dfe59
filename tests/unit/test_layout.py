"""Particles of a straight pipe: how many, where, of what kind."""

import numpy as np
import pytest

from mpsdem.geometry.layout import Kind, lattice_layout, ring_layout

LAYOUTS = pytest.mark.parametrize("layout", [ring_layout, lattice_layout])


def from_axis(position):
    return np.hypot(position[:, 1], position[:, 2])


def test_rings_stand_half_a_spacing_from_the_wall_and_a_spacing_apart():
    pipe = ring_layout(radius=0.1, length=0.4, spacing=0.02, ghost_layers=2)
    rings = {
        kind: np.unique(from_axis(pipe.position[pipe.kind == kind]).round(12)) for kind in Kind
    }
    np.testing.assert_allclose(rings[Kind.LIQUID], [0.01, 0.03, 0.05, 0.07, 0.09])
    np.testing.assert_allclose(rings[Kind.WALL], [0.11])
    np.testing.assert_allclose(rings[Kind.GHOST], [0.13, 0.15])


def test_a_ring_holds_the_whole_number_of_particles_nearest_to_its_arc_over_the_spacing():
    pipe = ring_layout(radius=0.1, length=0.02, spacing=0.02)
    _, counts = np.unique(from_axis(pipe.position).round(12), return_counts=True)
    assert list(counts) == [3, 9, 16, 22, 28, 35, 41]


def test_the_spacing_of_rings_is_the_nearest_that_divides_the_radius():
    pipe = ring_layout(radius=0.1, length=1.0, spacing=0.019)
    assert pipe.spacing == pytest.approx(0.02)
    assert pipe.spacing / 2 == pytest.approx(0.1 - from_axis(pipe.position[pipe.kind == 2]).max())


@LAYOUTS
def test_stations_divide_the_length(layout):
    pipe = layout(radius=0.1, length=0.41, spacing=0.02)
    stations = np.unique(pipe.position[:, 0])
    assert len(stations) == 20
    np.testing.assert_allclose(np.diff(stations), pipe.axial_spacing)
    gap_at_the_seam = stations[0] + 0.41 - stations[-1]
    assert gap_at_the_seam == pytest.approx(pipe.axial_spacing)


@LAYOUTS
def test_liquid_comes_first_then_the_wall_then_ghosts(layout):
    kind = layout(radius=0.1, length=0.2, spacing=0.02, ghost_layers=2).kind
    assert kind.dtype == np.int8
    changes = np.flatnonzero(np.diff(kind))
    assert list(kind[[0, *(changes + 1)]]) == [2, -2, -1]


@LAYOUTS
def test_every_cross_section_is_the_same(layout):
    pipe = layout(radius=0.1, length=0.2, spacing=0.02)
    sections = [pipe.position[pipe.position[:, 0] == x][:, 1:] for x in set(pipe.position[:, 0])]
    for section in sections:
        np.testing.assert_array_equal(section, sections[0])


@LAYOUTS
def test_without_ghost_layers_there_are_no_ghosts(layout):
    pipe = layout(radius=0.1, length=0.2, spacing=0.02, ghost_layers=0)
    assert set(pipe.kind) == {Kind.LIQUID, Kind.WALL}


@LAYOUTS
@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"radius": 0.0}, "radius = 0.0: must be > 0 m"),
        ({"length": np.inf}, "length = inf: must be > 0 m"),
        ({"spacing": np.nan}, "spacing = nan: must be > 0 m"),
        ({"spacing": 0.11}, "at most the radius, 0.1 m"),
        ({"length": 0.01}, "at most the length, 0.01 m"),
        ({"ghost_layers": -1}, "ghost_layers = -1: must be >= 0"),
    ],
)
def test_bad_input_names_field_and_rule(layout, change, message):
    with pytest.raises(ValueError, match=message):
        layout(**({"radius": 0.1, "length": 0.4, "spacing": 0.02} | change))
