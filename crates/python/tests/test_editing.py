"""Scenes as values: parts are added, removed, moved, scaled and painted, and pictures show exactly that."""

import types
import unittest

import enfilade
import numpy as np
from enfilade import Light, Material, Mesh, Scene

import datasets
from test_in_memory import box_room

SIZE = (64, 48)
RED = (0.8, 0.1, 0.2)


def room():
    return Scene.read(box_room(datasets.folder() / "edited"), up_axis="y", progress=False)


def table_on_floor():
    """A box of 1 x 2 x 0.5 m on a floor, below the sun."""
    floor = Mesh.box((10, 10, 0.2))
    scene = Scene.empty("studio").add(floor, (0, 0, -0.1), name="floor", label="floor", material=Material(0.4, name="stone"))
    return scene.add(Mesh.box((1, 2, 0.5)), (0, 0, 0.25), name="table", label="table").add_light(Light.sun((0, 0, -1), 3))


def from_above(scene, **options):
    camera = enfilade.Camera.look_at((0, 0, 4), (0, 0, 0), SIZE, 60, up=(0, 1, 0))
    return enfilade.render(scene, camera, samples=1, progress=False, **options), camera.K


def points_at(k, depth):
    """Where the rays of a camera that looks along an axis are at a depth, to the right and up, from the axis."""
    rows, columns = np.mgrid[0 : SIZE[1], 0 : SIZE[0]]
    return (columns - k[0, 2]) / k[0, 0] * depth, -(rows - k[1, 2]) / k[1, 1] * depth


class Pictures(unittest.TestCase):
    def test_depths_of_an_added_box_are_those_of_its_top(self):
        frame, k = from_above(table_on_floor(), denoise=False)
        x, y = points_at(k, 3.5)
        is_top = (abs(x) < 0.5) & (abs(y) < 1)
        np.testing.assert_allclose(frame["depth_z_meters"], np.where(is_top, 3.5, 4.0), atol=1e-5)
        np.testing.assert_array_equal(frame["render_entity_id"], np.where(is_top, 2, 1))
        np.testing.assert_array_equal(frame["semantic"], np.where(is_top, 7, 2))
        np.testing.assert_array_equal(frame["semantic_instance"], np.where(is_top, 1, -1))

    def test_moved_and_scaled_parts_are_seen_where_they_are(self):
        scene = table_on_floor().move("table", (1, 0, 0), turn_deg=90).scale("table", 0.5)
        np.testing.assert_allclose(scene.parts["table"].box, [[0.5, -0.25, 0], [1.5, 0.25, 0.25]], atol=1e-6)
        frame, k = from_above(scene, denoise=False)
        x, y = points_at(k, 3.75)
        is_top = (abs(x - 1) < 0.5) & (abs(y) < 0.25)
        np.testing.assert_allclose(frame["depth_z_meters"][is_top], 3.75, atol=1e-5)

    def test_what_moves_is_seen_where_it_is_at_a_moment(self):
        still = table_on_floor()
        scene = still.animate(of="table", times_s=[0, 2], distances_m=[0, 1], axis=[1, 0, 0]).animate(
            of="floor", on="table", times_s=[0], moved_m=[[0, 0, 0]]
        )
        bodies = [{**body, "parts": tuple(body["parts"])} for body in scene.bodies]
        table = {"name": "table", "parent": None, "joint": "slide", "limits": None, "moves": True, "parts": ("table",)}
        self.assertEqual(bodies, [table, {**table, "name": "floor", "parent": "table", "joint": "free", "moves": False, "parts": ("floor",)}])
        self.assertEqual((still.bodies, scene.at(1).bodies), ([], []))
        np.testing.assert_allclose(scene.at(1).parts["table"].box, [[0, -1, 0], [1, 1, 0.5]], atol=1e-6)
        np.testing.assert_allclose(scene.parts["table"].box, still.parts["table"].box)
        folder = datasets.folder() / "moving"
        folder.mkdir()
        for name in ("room.scene", "room.glb"):
            self.assertEqual([loss for loss in scene.save(folder / name) if "sun" not in loss], [])
            again = Scene.read(folder / name, progress=False)
            np.testing.assert_allclose(again.at(0.5).parts["table"].box, [[-0.25, -1, 0], [0.75, 1, 0.5]], atol=1e-5)
        for wrong, told in (
            (lambda: still.animate(of="tabel", times_s=[0], angles_deg=[3]), 'no part or object "tabel"; did you mean "table"'),
            (lambda: still.animate(of="table", times=[0]), "times_s"),
            (lambda: still.at(float("nan")), "time_s is NaN"),
        ):
            with self.assertRaisesRegex((ValueError, TypeError), told.replace("?", r"\?")):
                wrong()

    def test_a_painted_wall_has_the_colour_and_everything_else_stays(self):
        before = room()
        after = before.set_material("walls", Material(RED, name="paint"))
        camera = enfilade.Camera.look_at((1, -1, 1.5), (4, -4, 1), SIZE, 90)
        first, second = enfilade.render(before, camera, samples=16), enfilade.render(after, camera, samples=16)
        wall = first["render_entity_id"] == before.parts["walls"].render_entity_id
        # At borders a pixel's albedo is the mean of several surfaces.
        near = [np.roll(wall, (y, x), (0, 1)) for y in range(-2, 3) for x in range(-2, 3)]
        inner = np.all(near, axis=0)[2:-2, 2:-2]
        self.assertGreater(inner.sum(), 500)
        albedo = second["diffuse_reflectance"][2:-2, 2:-2][inner].astype(float)
        np.testing.assert_allclose(albedo, np.broadcast_to(RED, albedo.shape), rtol=0.01)
        for layer in ("depth_z_meters", "normal_world", "render_entity_id"):
            np.testing.assert_array_equal(first[layer], second[layer])
        self.assertEqual((before.parts["walls"].material, after.parts["walls"].material), ("white", "paint"))

    def test_a_texture_multiplies_the_colour(self):
        grey = np.full((4, 4, 3), 188, np.uint8)  # sRGB's 188 is 0.503.
        frame, k = from_above(table_on_floor().set_material("table", Material((1, 0.5, 0.25), texture=grey)), denoise=False)
        np.testing.assert_allclose(frame["diffuse_reflectance"][24, 32], [0.503, 0.2515, 0.1257], rtol=0.01)

    def test_a_lamp_shines_and_a_scene_without_light_or_parts_is_refused_as_its_file_is(self):
        dark = table_on_floor().remove_light("sun")
        with self.assertRaisesRegex(RuntimeError, "no light"):
            from_above(dark)
        lit = dark.add(Mesh.sphere(0.1), (0, 0, 2), name="lamp", label="lamp", material=Material(emission=50))
        frame, _ = from_above(lit, layers=["color", "semantic"])
        self.assertTrue((frame["color"][frame["semantic"] == 2] > 0).any() and (frame["semantic"] == 35).any())
        for action in (from_above, lambda scene: scene.camera(), lambda scene: scene.save(datasets.folder() / "empty.scene")):
            with self.assertRaisesRegex(RuntimeError, "no visible parts"):
                action(Scene.empty())
        self.assertIn("0 parts", Scene.empty().summary)
        self.assertIn("<svg", Scene.empty()._repr_html_())


class Edits(unittest.TestCase):
    def bytes_of(self, scene, name="scene.scene"):
        path = datasets.folder() / name
        scene.save(path)
        return path.read_bytes()

    def test_edits_leave_the_scene_and_what_is_added_and_removed_leaves_no_trace(self):
        scene = room()
        before = self.bytes_of(scene)
        added = scene.add(Mesh.box((1, 1, 1)), (1, -1, 0.5), name="box", label="box", material=Material(RED, roughness=0.2))
        self.assertEqual((len(scene.parts), len(added.parts), added.parts[-1].label), (3, 4, "box"))
        moved = added.move("box", (0.5, 0, 0)).scale("box", 2)
        self.assertEqual(self.bytes_of(moved.remove("box")), before)
        self.assertEqual(self.bytes_of(scene), before)

    def test_edited_scenes_are_saved_and_read_again(self):
        file = box_room(datasets.folder() / "edited")
        scene = room().add(file, (5, 0, 0), up_axis="y", name="annex", label="otherfurniture").set_material("walls", Material(RED, name="paint"))
        scene = scene.add_light(Light.spot((1, -1, 2.5), (1, -1, 0), 10)).add_camera(enfilade.Camera.look_at((1, -1, 1), (3, -3, 1), name="door"))
        for name in ("edited.scene", "edited.glb"):
            self.bytes_of(scene, name)
            again = Scene.read(datasets.folder() / name)
            self.assertEqual(again.parts.names, scene.parts.names, name)
            self.assertEqual((again.cameras, [light.kind for light in again.lights]), (["door"], ["spot"]), name)
            np.testing.assert_array_equal(again.labels, scene.labels)
            for one, two in zip(again.parts, scene.parts, strict=True):
                np.testing.assert_allclose(one.box, two.box, atol=1e-5)
                self.assertEqual(one.material, two.material)

    def test_files_come_with_one_label_and_their_parts_under_a_name(self):
        file = box_room(datasets.folder() / "edited")
        scene = room().add(file, up_axis="y", label="bookshelf").add(file, up_axis="y", label="bookshelf")
        self.assertEqual(scene.parts.names[3:], [f"{room}/{part}" for room in ("room", "room_2") for part in ("walls", "floor", "ceiling")])
        self.assertEqual([part.instance for part in scene.parts[3:]], [1, 1, 1, 2, 2, 2])
        self.assertEqual(scene.materials, room().materials)
        self.assertEqual(scene.remove("room").remove("room_2").parts.names, room().parts.names)
        whole = Scene.empty().add(room(), name="hall").add(room(), (0, 9, 0), name="hall")
        np.testing.assert_allclose(whole.bounds[1] - whole.bounds[0], [4, 13, 3], atol=1e-5)

    def test_meshes_of_other_libraries_and_pairs_of_arrays_are_meshes(self):
        box = Mesh.box((1, 2, 3))
        foreign = types.SimpleNamespace(vertices=box.vertices, faces=box.triangles)
        for source in (box, foreign, (box.vertices, box.triangles), (box.vertices.tolist(), box.triangles.tolist())):
            part = Scene.empty().add(source, name="box").parts["box"]
            np.testing.assert_array_equal(part.mesh.triangles, box.triangles)
            np.testing.assert_array_equal(part.box, [[-0.5, -1, -1.5], [0.5, 1, 1.5]])
        smooth = Mesh(box.vertices, box.triangles, normals=10 * box.vertices, uvs=box.uvs)
        np.testing.assert_allclose(np.linalg.norm(smooth.normals, axis=1), 1, atol=1e-6)
        self.assertIsNone(box.normals)

    def test_poses_are_positions_or_matrices_and_mirrors_keep_fronts(self):
        mirror = np.diag([-1.0, 1, 1, 1])
        mirror[:3, 3] = (1, 2, 3)
        for pose in (mirror, mirror[:3]):
            part = Scene.empty().add(Mesh.box((1, 1, 1)), pose, name="box").parts["box"]
            np.testing.assert_array_equal(part.pose, mirror)
            corners = part.mesh.vertices[part.mesh.triangles] @ mirror[:3, :3].T
            volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
            self.assertAlmostEqual(volume, 1, places=5)
        turned = Scene.empty().add(Mesh.box((1, 2, 3)), (0, 0, 0), turn_deg=90, name="box")
        np.testing.assert_allclose(turned.bounds, [[-1, -0.5, -1.5], [1, 0.5, 1.5]], atol=1e-6)
        np.testing.assert_allclose(turned.move("box", to=(5, 5, 0)).bounds, [[4, 4.5, 0], [6, 5.5, 3]], atol=1e-6)

    def test_parts_are_found_by_number_and_name(self):
        parts = table_on_floor().parts
        floor, table = parts
        self.assertEqual((len(parts), parts[-1].name, [part.name for part in parts[:1]]), (2, "table", ["floor"]))
        self.assertEqual((floor.semantic, floor.instance, table.semantic, table.instance, table.object), (2, -1, 7, 1, None))
        self.assertEqual((parts["table"].render_entity_id, "table" in parts, "chair" in parts, floor in parts), (2, True, False, True))
        self.assertEqual((floor.material, floor.pose.shape, floor.mesh.vertices.shape), ("stone", (4, 4), (24, 3)))
        with self.assertRaisesRegex(KeyError, 'no part "tabel"; did you mean "table"'):
            parts["tabel"]
        with self.assertRaisesRegex(IndexError, "part 2 of a scene of 2 parts"):
            parts[2]
        floors = [part for part in parts if part.label == "floor"]
        self.assertEqual(table_on_floor().remove(floors).parts.names, ["table"])

    def test_lights_say_what_they_are(self):
        scene = table_on_floor().add_light(Light.point((1, 2, 3), (4, 5, 6))).add_light(Light.point((1, 2, 3), 4))
        self.assertEqual([(light.name, light.kind) for light in scene.lights], [("sun", "sun"), ("light", "point"), ("light_2", "point")])
        sun, point, _ = scene.lights
        np.testing.assert_array_equal([*sun.direction, *sun.irradiance], [0, 0, -1, 3, 3, 3])
        np.testing.assert_array_equal([*point.position, *point.intensity], [1, 2, 3, 4, 5, 6])
        self.assertEqual((sun.position, sun.intensity, point.direction, point.irradiance), (None,) * 4)

    def test_what_cannot_be_is_refused_with_a_reason(self):
        scene, box = table_on_floor(), Mesh.box((1, 1, 1))
        far = enfilade.Camera(None, (64, 32), np.eye(4), model="equirectangular")
        cases = [
            (lambda: scene.remove("tabel"), 'no part or object "tabel"; did you mean "table"'),
            (lambda: scene.set_material("table", "ston"), 'no material "ston"; did you mean "stone"'),
            (lambda: scene.remove_light("son"), 'no light "son"; did you mean "sun"'),
            (lambda: scene.remove_camera("door"), 'no camera "door"'),
            (lambda: scene.add(box, label="lmap"), 'no class "lmap"; did you mean "lamp"'),
            (lambda: scene.add(box, label=41), "label is 41"),
            (lambda: scene.add(box, np.zeros((4, 4))), "last row"),
            (lambda: scene.add(box, np.diag([1, 0, 1, 1]), name="flat"), 'part "flat": its placement cannot be inverted'),
            (lambda: scene.add(box, (np.nan, 0, 0), name="lost"), 'part "lost": its placement cannot be inverted'),
            (lambda: scene.add(box, (1, 2)), "pose has the shape"),
            (lambda: scene.add("room.obj", up_axis="w"), "up_axis is"),
            (lambda: scene.move("table", np.diag([1, 1, 0, 1])), 'part "table": its placement cannot be inverted'),
            (lambda: scene.move("table"), "how far"),
            (lambda: scene.move("table", (1, 0, 0), to=(1, 0, 0)), "not both"),
            (lambda: scene.scale("table", 0), "expected more than 0"),
            (lambda: scene.add((box.vertices[:, :2], box.triangles)), "vertices has the shape"),
            (lambda: Mesh(box.vertices, box.triangles + 20), "refers to vertex"),
            (lambda: Mesh(box.vertices * np.nan, box.triangles), "not finite"),
            (lambda: Mesh(box.vertices, box.triangles, normals=0 * box.vertices), "the normal of vertex 0"),
            (lambda: Mesh(box.vertices, []), "no triangles"),
            (lambda: Mesh(box.vertices, [[0, 1, -1]]), "triangle 0 is .*expected 3 indices"),
            (lambda: Mesh.box((1, 0, 1)), "expected more than 0"),
            (lambda: Material((0.5, 0.5, 1.5)), "color is 1.5; expected 0 to 1"),
            (lambda: Material(0.5, metallic=1), "give the metal a roughness"),
            (lambda: Material(0.5, roughness=-1), "roughness is -1"),
            (lambda: Material(emission=-1), "emission is -1"),
            (lambda: Light.point((0, 0, np.inf), 1), "finite"),
            (lambda: Light.spot((0, 0, 1), (0, 0, 1), 1), "expected a direction"),
            (lambda: scene.add_camera(far), "half of the world"),
            (lambda: scene.add((box.vertices, box.triangles), material=Material(texture=np.zeros((2, 2, 3), np.uint8))), "no texture coordinates"),
        ]
        for make, said in cases:
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                make()
        for make in (lambda: scene.add(3), lambda: scene.remove(3), lambda: scene.set_material("table", 3)):
            with self.assertRaises(TypeError):
                make()
        with self.assertRaisesRegex(RuntimeError, "gone.glb"):
            scene.add("gone.glb")


if __name__ == "__main__":
    unittest.main()
