"""What is drawn, when, and that a recording holds all of it."""

import copy

import numpy as np
import pytest
from fake_clock import FakeClock
from pydrake.autodiffutils import AutoDiffXd
from pydrake.common.value import Value
from pydrake.geometry import Rgba
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.systems.analysis import Simulator_
from visualizer_rig import (
    MAX_FORCE_N,
    MAX_TORQUE_NM,
    X_HT,
    X_WH,
    FakeMeshcat,
    Frozen,
    make_contacts,
    make_context,
    make_mesh,
    make_picture,
    make_visualizer,
)

from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.output import haptic_visualizer
from drake_haptics.systems.output.meshcat_shapes import ArrowPool, MovingParts


@pytest.fixture
def meshcat():
    return FakeMeshcat()


@pytest.fixture
def visualizer(meshcat):
    return make_visualizer(meshcat)


def test_tool_and_ghost_are_where_the_ports_say(meshcat, visualizer):
    X_WT = RigidTransform(RollPitchYaw(1, 2, 3), [1, 2, 3])
    visualizer.ForcedPublish(make_context(visualizer, X_WT=X_WT))
    assert meshcat.transforms["/haptics/tool"].IsNearlyEqualTo(X_WT, 1e-12)
    ghost = meshcat.transforms["/haptics/handle"]
    assert ghost.IsNearlyEqualTo(X_WH @ X_HT, 1e-12)


def test_the_line_joins_the_handle_and_the_point_of_the_tool_that_it_holds(
    meshcat, visualizer
):
    offset = RigidTransform(np.array([0.003, 0.0, 0.004]))
    visualizer.ForcedPublish(make_context(visualizer, X_WT=offset @ X_WH @ X_HT))
    X_WLine = meshcat.transforms["/haptics/coupling"]
    scale = meshcat.properties["/haptics/coupling/line", "scale"]
    assert scale == pytest.approx([1, 1, 0.005])
    half = X_WLine.rotation().matrix()[:, 2] * scale[2] / 2
    np.testing.assert_allclose(
        X_WLine.translation() - half, X_WH.translation(), atol=1e-12
    )
    np.testing.assert_allclose(
        X_WLine.translation() + half,
        X_WH.translation() + offset.translation(),
        atol=1e-12,
    )


def test_no_line_is_seen_while_handle_and_tool_were_never_apart(meshcat, visualizer):
    visualizer.ForcedPublish(make_context(visualizer))
    assert meshcat.properties["/haptics/coupling/line", "scale"][2] < 1e-6


def assert_tip_is_at(meshcat, path, p_W):
    """Checks where an arrow of length 1 along z, scaled and placed, ends."""
    tip = [0, 0, meshcat.properties[f"{path}/arrow", "scale"][2]]
    np.testing.assert_allclose(meshcat.transforms[path] @ tip, p_W, atol=1e-12)


def test_contacts_are_green_near_and_red_penetrating(meshcat, visualizer):
    visualizer.ForcedPublish(make_context(visualizer, [0.001, -0.002]))
    # The deepest first; child 0 is green, child 1 is red.
    assert meshcat.visible("/haptics/contacts") == [
        "/haptics/contacts/0/arrow/1",
        "/haptics/contacts/1/arrow/0",
    ]
    assert_tip_is_at(meshcat, "/haptics/contacts/0", [3, 4, 5])


def test_an_arrow_that_moves_keeps_its_length(meshcat):
    pool = ArrowPool(MovingParts(meshcat), "/a", 1, [Rgba(1, 0, 0)])
    for x in (0.0, 0.1, 0.2):
        p_W = np.array([[x, 0, 0]])
        list(pool.draw([0], p_W, np.array([[0, 0, 0.02]]), [0], 0.0))
        assert_tip_is_at(meshcat, "/a/0", p_W[0])


def test_contact_arrows_point_along_the_normal(meshcat, visualizer):
    context = make_context(visualizer)
    nhat = np.array([0.6, 0.0, -0.8])
    visualizer.GetInputPort("contacts").FixValue(
        context, Value(make_contacts([0.001], nhat))
    )
    visualizer.ForcedPublish(context)
    R = meshcat.transforms["/haptics/contacts/0"].rotation().matrix()
    np.testing.assert_allclose(R[:, 2], nhat, atol=1e-12)


def test_arrows_disappear_with_their_contacts(meshcat, visualizer):
    visualizer.StartRecording()  # so that no frame is left out
    visualizer.ForcedPublish(make_context(visualizer, [-0.001, -0.001]))
    assert len(meshcat.visible("/haptics/contacts")) == 2
    visualizer.ForcedPublish(make_context(visualizer, []))
    assert meshcat.visible("/haptics") == []


def test_more_contacts_than_arrows_leaves_the_deepest(meshcat, visualizer):
    distance = np.linspace(0.002, -0.002, 200)
    visualizer.ForcedPublish(make_context(visualizer, distance))
    visible = meshcat.visible("/haptics/contacts")
    assert len(visible) == 64
    assert all(path.endswith("/1") for path in visible)


def test_force_arrows_grow_with_the_force(meshcat, visualizer):
    forces = [(0, 0, 1.0), (0, 2.0, 0), (0, 0, 0)]
    visualizer.ForcedPublish(make_context(visualizer, [-0.001] * 3, forces))
    length = [
        meshcat.properties[f"/haptics/clusters/{i}/arrow", "scale"][0] for i in (0, 1)
    ]
    assert length[1] == pytest.approx(2 * length[0])
    # No direction, no arrow.
    assert len(meshcat.visible("/haptics/clusters")) == 2


def test_the_force_on_the_hand_is_drawn_at_the_handle(meshcat, visualizer):
    visualizer.ForcedPublish(make_context(visualizer, f_H_W=(0, -3.0, 0)))
    X_WArrow = meshcat.transforms["/haptics/force/0"]
    assert_tip_is_at(meshcat, "/haptics/force/0", X_WH.translation())
    np.testing.assert_allclose(
        X_WArrow.rotation().matrix()[:, 2], [0, -1, 0], atol=1e-9
    )


def test_the_torque_on_the_hand_begins_at_the_handle_along_its_axis(
    meshcat, visualizer
):
    visualizer.ForcedPublish(make_context(visualizer, tau_H_W=(0.12, 0, -0.16)))
    X_WArrow = meshcat.transforms["/haptics/torque/0"]
    np.testing.assert_allclose(X_WArrow.translation(), X_WH.translation())
    axis = X_WArrow.rotation().matrix()[:, 2]
    np.testing.assert_allclose(axis, [0.6, 0, -0.8], atol=1e-9)
    assert meshcat.visible("/haptics/torque") == ["/haptics/torque/0/arrow/0"]
    assert meshcat.visible("/haptics/force") == []


@pytest.mark.parametrize("share", [0.5, 1.0, 30.0])
def test_an_arrow_is_as_long_as_its_share_of_the_devices_limit(
    meshcat, visualizer, share
):
    """At the limit a third of the tool's size, and never more."""
    size_m = np.linalg.norm(np.ptp(make_mesh().vertices, axis=0))
    wrench = {
        "f_H_W": (0, share * MAX_FORCE_N, 0),
        "tau_H_W": (0, 0, share * MAX_TORQUE_NM),
    }
    visualizer.ForcedPublish(make_context(visualizer, **wrench))
    for name in ("force", "torque"):
        length = meshcat.properties[f"/haptics/{name}/0/arrow", "scale"][0]
        assert length == pytest.approx(min(share, 1.0) * size_m / 3)


def test_a_device_without_torque_has_no_arrow_of_it(meshcat):
    visualizer = make_visualizer(meshcat, max_torque_Nm=0.0)
    visualizer.ForcedPublish(make_context(visualizer, f_H_W=(0, 1.0, 0)))
    assert meshcat.visible("/haptics/torque") == []
    assert len(meshcat.visible("/haptics/force")) == 1


def test_friction_is_drawn_dark_where_it_sticks_and_light_where_it_slides(meshcat):
    visualizer = make_visualizer(meshcat, has_friction=True)
    context = make_context(visualizer, [-1e-3] * 3)
    # The third cluster has none.
    force = np.array([[0.3, 0, 0], [0, -0.3, 0], [0, 0, 0]])
    friction = Frozen(f_cluster_W=force, sliding=np.array([False, True, False]))
    visualizer.GetInputPort("friction_force").FixValue(context, Value(friction))
    visualizer.ForcedPublish(context)
    folder = "/haptics/friction"
    assert meshcat.visible(folder) == [f"{folder}/0/arrow/0", f"{folder}/1/arrow/1"]
    arrow = meshcat.transforms[f"{folder}/1"]
    np.testing.assert_allclose(arrow.rotation().matrix()[:, 2], [0, -1, 0], atol=1e-12)


def test_without_friction_there_is_no_arrow_and_no_port_for_it(meshcat, visualizer):
    assert not visualizer.HasInputPort("friction_force")
    assert not [path for path, _ in meshcat.properties if "friction" in path]


def test_objects_that_move_follow_their_port_and_others_are_placed_once(meshcat):
    X_WO = RigidTransform(np.array([1.0, 2, 3]))
    objects = [
        ContactObject("table", make_mesh(), X_WO),
        ContactObject("lid", make_mesh(), None),
    ]
    visualizer = make_visualizer(meshcat, objects)
    assert meshcat.transforms["/haptics/objects/table"].IsNearlyEqualTo(X_WO, 1e-12)
    context = make_context(visualizer)
    visualizer.GetInputPort("X_WO_lid").FixValue(context, pose_to_vector(X_WH))
    visualizer.ForcedPublish(context)
    assert meshcat.transforms["/haptics/objects/lid"].IsNearlyEqualTo(X_WH, 1e-12)


def test_views_are_sent_once_and_then_only_shown_and_hidden(monkeypatch):
    clock = FakeClock()
    monkeypatch.setattr(haptic_visualizer.time, "perf_counter", clock)
    meshcat = FakeMeshcat()
    table = ContactObject("table", make_mesh(), RigidTransform())
    visualizer = make_visualizer(meshcat, [table])
    context = make_context(visualizer)

    def see(view, visible):
        meshcat.properties.clear()
        visualizer.Show(view, visible)
        clock.now_s += 1.0
        visualizer.ForcedPublish(context)
        return {
            path.removeprefix("/haptics/"): value
            for (path, name), value in meshcat.properties.items()
            if name == "visible"
        }

    assert not any("/pieces/" in path for path in meshcat.objects)
    seen = see("pieces", True)
    sent = {path for path in meshcat.objects if "/pieces/" in path}
    assert sent == {"/haptics/tool/pieces/0", "/haptics/objects/table/pieces/0"}
    assert (
        not seen["tool/<object>"] and seen["tool/pieces"] and not seen["tool/virtual"]
    )
    meshcat.objects.clear()
    seen = see("virtual", True)
    assert seen["objects/table/virtual"] and seen["objects/table/pieces"]
    seen = see("pieces", False)
    assert seen["tool/<object>"] and not seen["tool/pieces"] and seen["tool/virtual"]
    assert see("ghost", False) == {"handle": False, "grip": False, "coupling": False}
    assert see("contacts", False) == {"contacts": False}
    assert see("forces", False) == dict.fromkeys(
        ("force", "torque", "clusters", "friction"), False
    )
    assert see("forces", True) == dict.fromkeys(
        ("force", "torque", "clusters", "friction"), True
    )
    assert see("forces", True) == {}
    assert not meshcat.objects


def hide_while_pieces_are_sent(meshcat, view):
    picture = make_picture(meshcat)
    picture.show("pieces", True)
    drawing = picture.draw_views()
    next(drawing)
    picture.show(view, False)
    list(drawing)
    list(picture.draw_views())


def test_a_view_that_is_hidden_while_pieces_are_sent_is_hidden(meshcat):
    hide_while_pieces_are_sent(meshcat, "ghost")
    assert meshcat.properties["/haptics/handle", "visible"] is False
    assert meshcat.properties["/haptics/tool/pieces", "visible"] is True


def test_pieces_that_are_hidden_while_they_are_sent_are_hidden(meshcat):
    hide_while_pieces_are_sent(meshcat, "pieces")
    assert "/haptics/tool/pieces/0" in meshcat.objects
    assert meshcat.properties["/haptics/tool/pieces", "visible"] is False
    assert meshcat.properties.get(("/haptics/tool/<object>", "visible"), True)


def test_views_of_a_frame_that_is_broken_off_are_drawn_in_the_next_one(meshcat):
    picture = make_picture(meshcat)
    for view in ("contacts", "ghost"):
        picture.show(view, False)
    next(picture.draw_views())
    list(picture.draw_views())
    assert meshcat.properties["/haptics/handle", "visible"] is False
    assert meshcat.properties["/haptics/contacts", "visible"] is False


def test_a_view_that_there_is_not_is_refused():
    with pytest.raises(ValueError, match=r"view must be one of pieces,.*'piece'"):
        make_visualizer(FakeMeshcat()).Show("piece", True)


def test_an_arrow_stays_in_its_slot_while_others_come_and_go(meshcat):
    pool = ArrowPool(MovingParts(meshcat), "/a", 4, [Rgba(1, 0, 0)])
    up = np.array([[0, 0, 1.0]] * 3)

    def draw(keys):
        p_W = np.array([[ord(key), 0, 1] for key in keys], dtype=float)
        list(pool.draw(keys, p_W, up[: len(keys)], [0] * len(keys), 0.0))
        return {
            chr(
                int(meshcat.transforms[path.removesuffix("/arrow/0")].translation()[0])
            ): path
            for path in meshcat.visible("/a")
        }

    first = draw("ab")
    second = draw("xby")
    third = draw("yb")
    assert first["b"] == second["b"] == third["b"]
    assert second["y"] == third["y"]
    assert set(first) == {"a", "b"} and set(second) == {"x", "b", "y"}
    assert set(third) == {"y", "b"}


def test_what_does_not_change_is_not_sent_again(meshcat):
    pool = ArrowPool(MovingParts(meshcat), "/a", 64, [Rgba(1, 0, 0), Rgba(0, 1, 0)])
    calls = []
    meshcat.SetProperty = lambda *args: calls.append(args)
    list(pool.draw([1], np.zeros((1, 3)), np.ones((1, 3)), [1], 0.0))
    assert [args[1] for args in calls] == ["scale", "visible"]
    calls.clear()
    list(pool.draw([1], np.zeros((1, 3)), np.ones((1, 3)), [1], 0.0))
    assert calls == []
    list(pool.draw([1], np.zeros((1, 3)), 2 * np.ones((1, 3)), [1], 0.0))
    assert [args[1] for args in calls] == ["scale"]


def test_no_context_is_kept():
    visualizer = make_visualizer(FakeMeshcat())
    context = make_context(visualizer, [-0.001])
    twin = copy.deepcopy(context)
    visualizer.ForcedPublish(twin)
    assert not any(
        type(value).__name__ == "LeafContext" for value in vars(visualizer).values()
    )


def test_its_twin_takes_the_same_and_draws_nothing(meshcat):
    visualizer = make_visualizer(meshcat, [ContactObject("lid", make_mesh(), None)])
    sent = len(meshcat.transforms), len(meshcat.properties), len(meshcat.objects)
    twin = visualizer.ToAutoDiffXd()
    ports = [
        [system.get_input_port(i).get_name() for i in range(system.num_input_ports())]
        for system in (visualizer, twin)
    ]
    assert ports[0] == ports[1]
    # Nothing is connected: whatever read an input would fail.
    Simulator_[AutoDiffXd](twin).AdvanceTo(AutoDiffXd(0.2))
    twin.ForcedPublish(twin.CreateDefaultContext())
    assert sent == (
        len(meshcat.transforms),
        len(meshcat.properties),
        len(meshcat.objects),
    )
