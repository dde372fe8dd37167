"""Runs of MuJoCo without MuJoCo: a model that has its arrays, recorded and read back as a scene that moves."""

import math
import types
import unittest

import enfilade
import numpy as np

import datasets

NAMES = b"\0floor\0arm\0turn\0plate\0tile\0wrist\0sun\0"


def at(name):
    return NAMES.index(b"\0" + name + b"\0") + 1


def model():
    """A floor, and an arm with a hinge about z at (0, 0, 1), which bears a triangle of 1 m and a camera."""
    floats = lambda *rows: np.array(rows, float)
    return types.SimpleNamespace(
        names=NAMES, nq=1, nbody=2, njnt=1, ngeom=2, nmat=1, ncam=1, nlight=1,
        opt=types.SimpleNamespace(timestep=0.01), stat=types.SimpleNamespace(center=np.zeros(3)),
        name_bodyadr=[0, at(b"arm")], name_jntadr=[at(b"turn")], name_geomadr=[at(b"floor"), at(b"plate")],
        name_matadr=[at(b"tile")], name_camadr=[at(b"wrist")], name_lightadr=[at(b"sun")],
        body_parentid=[0, 0], body_pos=floats([0, 0, 0], [0, 0, 1]), body_quat=floats([1, 0, 0, 0], [1, 0, 0, 0]), body_mocapid=[-1, -1],
        jnt_type=[3], jnt_bodyid=[1], jnt_pos=floats([0, 0, 0]), jnt_axis=floats([0, 0, 1]), jnt_qposadr=[0], jnt_limited=[1],
        jnt_range=floats([-1, 2]), qpos0=np.zeros(1),
        geom_type=[0, 7], geom_bodyid=[0, 1], geom_pos=floats([0, 0, 0], [0.5, 0, 0]), geom_quat=floats([1, 0, 0, 0], [1, 0, 0, 0]),
        geom_rgba=floats([0.5, 0.5, 0.5, 1], [1, 0, 0, 1]), geom_group=[0, 2], geom_contype=[1, 0], geom_conaffinity=[1, 0],
        geom_size=floats([3, 3, 0.1], [0, 0, 0]), geom_matid=[0, -1], geom_dataid=[-1, 0],
        mesh_vert=np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "f4"), mesh_vertadr=[0], mesh_face=np.array([[0, 1, 2]]), mesh_faceadr=[0],
        mesh_facenum=[1], mesh_normal=np.array([[0, 0, 1]], "f4"), mesh_normaladr=[0], mesh_facenormal=np.array([[0, 0, 0]]),
        mesh_texcoordadr=[-1], mesh_texcoord=np.empty((0, 2), "f4"), mesh_facetexcoord=np.array([[0, 0, 0]]),
        mat_rgba=floats([1, 1, 1, 1]), mat_texrepeat=floats([2, 2]), mat_texuniform=[0], mat_texid=[[-1, 0, -1]], mat_emission=[0.0],
        mat_specular=[0.5], mat_shininess=[0.5], mat_reflectance=[0.0],
        tex_type=[0], tex_width=[2], tex_height=[1], tex_nchannel=[3], tex_adr=[0], tex_data=np.array([255, 0, 0, 0, 0, 255], "u1"),
        cam_bodyid=[1], cam_pos=floats([0, 0, 1]), cam_quat=floats([1, 0, 0, 0]), cam_fovy=[60.0], cam_resolution=[[640, 480]], cam_mode=[0],
        light_bodyid=[0], light_type=[1], light_active=[1], light_pos=floats([0, 0, 3]), light_dir=floats([0, 0, -1]),
        light_diffuse=floats([1, 1, 1]), light_cutoff=[45.0], light_mode=[0],
    )


def state(time, angle):
    sin, cos = math.sin(angle), math.cos(angle)
    empty = np.empty((0, 3)), np.empty((0, 4))
    return types.SimpleNamespace(
        time=time, qpos=np.array([angle]), mocap_pos=empty[0], mocap_quat=empty[1], cam_xpos=np.array([[0.0, 0.0, 2.0]]),
        cam_xmat=np.array([[cos, -sin, 0, sin, cos, 0, 0, 0, 1.0]]),
    )


class Recorder(unittest.TestCase):
    def recorder(self):
        recorder = enfilade.MujocoRecorder(model())
        for step in range(11):
            recorder.step(state(0.1 * step, 0.05 * math.pi * step))
        return recorder

    def test_a_run_becomes_a_scene_with_its_parts_and_bodies(self):
        file = datasets.folder() / "run.scene"
        done = self.recorder().save(file)
        self.assertTrue(done["report"].endswith("run.report.json"))
        scene = enfilade.Scene.read(file, progress=False)
        self.assertEqual([part.name for part in scene.parts], ["floor", "plate"])
        np.testing.assert_allclose(scene.parts["plate"].box, [[0.5, 0, 1], [1.5, 1, 1]], atol=1e-6)
        self.assertEqual((scene.cameras, len(scene.lights)), (["wrist"], 1))
        self.assertFalse(any("camera" in warning["place"] for warning in done["warnings"]))

    def test_states_of_another_model_and_wrong_ones_are_refused(self):
        recorder = enfilade.MujocoRecorder(model())
        with self.assertRaisesRegex(ValueError, "nothing was recorded"):
            recorder.save(datasets.folder() / "none.scene")
        with self.assertRaisesRegex(ValueError, "it is of another model"):
            recorder.step(types.SimpleNamespace(time=0.0, qpos=np.zeros(7)))
        with self.assertRaisesRegex(ValueError, "step 0 .* no finite numbers"):
            recorder.step(state(0.0, math.nan))
        recorder.step(state(1.0, 0.0))
        with self.assertRaisesRegex(ValueError, "step 1 is at 0.5 s, before"):
            recorder.step(state(0.5, 0.0))


if __name__ == "__main__":
    unittest.main()
