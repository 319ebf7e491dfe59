"""Layers of liquid, wall and ghosts against the wall itself, for any pipe."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from mpsdem._core.geometry import Cylinder
from mpsdem.geometry.layout import Kind, lattice_layout, ring_layout

AT_REST = (0.0, 0.0, 0.0)


@st.composite
def pipes(draw):
    radius = draw(st.floats(1e-3, 1e3))
    spacing = radius / draw(st.floats(1, 12))
    length = spacing * draw(st.floats(1, 9))
    ghost_layers = draw(st.integers(0, 3))
    return {"radius": radius, "length": length, "spacing": spacing, "ghost_layers": ghost_layers}


def layers(layout, pipe):
    """The layout, and the distance of its particles from the wall in spacings by kind."""
    made = layout(**pipe)
    wall = Cylinder(radius=pipe["radius"], velocity=AT_REST)
    distance = wall.distance(made.position) / made.spacing
    return made, {kind: distance[made.kind == kind] for kind in Kind}


def periodic_tree(position, period, reach):
    """A tree that holds the points and their images within reach of the ends."""
    images = int(np.ceil(reach / period))
    shift = np.zeros((2 * images + 1, 1, 3))
    shift[:, 0, 0] = period * np.arange(-images, images + 1)
    return cKDTree((position + shift).reshape(-1, 3))


@settings(max_examples=30)
@given(pipes())
def test_rings_follow_the_wall(pipe):
    made, distance = layers(ring_layout, pipe)
    steps = distance[Kind.LIQUID] - 0.5
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)
    assert steps.min() == pytest.approx(0, abs=1e-9)
    np.testing.assert_allclose(distance[Kind.WALL], -0.5, atol=1e-9)
    behind = -1.5 - np.arange(pipe["ghost_layers"])
    np.testing.assert_allclose(np.unique(distance[Kind.GHOST].round(9)), behind[::-1], atol=1e-9)
    assert made.spacing == pytest.approx(pipe["spacing"], rel=0.5)


@settings(max_examples=30)
@given(pipes())
def test_the_lattice_is_cut_by_the_distance_from_the_wall(pipe):
    made, distance = layers(lattice_layout, pipe)
    assert distance[Kind.LIQUID].min() > 0
    assert distance[Kind.WALL].min() > -1
    assert distance[Kind.WALL].max() <= 0
    if pipe["ghost_layers"]:
        assert distance[Kind.GHOST].min() > -1 - pipe["ghost_layers"]
        assert distance[Kind.GHOST].max() <= -1
    assert made.spacing == pipe["spacing"]


@settings(max_examples=30)
@pytest.mark.parametrize("layout", [ring_layout, lattice_layout])
@given(pipes())
def test_no_two_particles_are_close_and_no_hole_is_between_them(layout, pipe):
    made = layout(**pipe)
    tree = periodic_tree(made.position, pipe["length"], 2 * made.spacing)
    nearest = tree.query(made.position, k=2)[0][:, 1] / made.spacing
    assert nearest.min() > 0.6
    assert nearest.max() < 1.5

    rng = np.random.default_rng(1)
    r = (pipe["radius"] + made.spacing * 0.5) * np.sqrt(rng.random(400))
    angle = rng.uniform(0, 2 * np.pi, 400)
    anywhere = np.column_stack(
        [rng.uniform(0, pipe["length"], 400), r * np.cos(angle), r * np.sin(angle)]
    )
    widest = max(made.spacing, made.axial_spacing)
    assert tree.query(anywhere)[0].max() < 1.1 * widest


@settings(max_examples=30)
@given(pipes())
def test_the_liquid_of_rings_fills_the_bore(pipe):
    made = ring_layout(**pipe)
    cell = made.spacing**2 * made.axial_spacing
    bore = np.pi * pipe["radius"] ** 2 * pipe["length"]
    tolerance = 0.01 if pipe["radius"] > 2.5 * made.spacing else 0.05
    assert np.sum(made.kind == 2) * cell == pytest.approx(bore, rel=tolerance)


@settings(max_examples=30)
@pytest.mark.parametrize(
    ("layout", "reach", "ghost_layers"),
    [
        (ring_layout, 2.1, 1),
        (ring_layout, 3.1, 2),
        (lattice_layout, 2.1, 2),
        (lattice_layout, 3.1, 3),
    ],
)
@given(pipes())
def test_a_further_ghost_layer_would_be_out_of_the_liquids_reach(layout, reach, ghost_layers, pipe):
    made = layout(**pipe | {"ghost_layers": ghost_layers + 1})
    fewer = layout(**pipe | {"ghost_layers": ghost_layers})
    further = made.position[len(fewer.position) :]
    np.testing.assert_array_equal(made.position[: len(fewer.position)], fewer.position)
    tree = periodic_tree(further, pipe["length"], reach * made.spacing)
    liquid = made.position[made.kind == Kind.LIQUID]
    assert tree.query(liquid)[0].min() > reach * made.spacing
