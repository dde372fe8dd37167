"""Validates USD files: python validate_usd.py SCENE.usda...

Fails with what the validators of usd-core find wrong, and prints one line of JSON for each file: numbers of rigid bodies, colliders and joints as
UsdPhysics parses them.
"""

import json
import sys

try:
    from pxr import Usd, UsdPhysics, UsdValidation
except ImportError:
    sys.exit(77)


def main():
    for path in sys.argv[1:]:
        stage = Usd.Stage.Open(path)
        wrong = [str(error.GetMessage()) for error in validated(stage)]
        if wrong:
            sys.exit(f"{path}: {len(wrong)} problems\n" + "\n".join(wrong[:20]))
        prims = list(stage.Traverse())
        count = lambda api: sum(prim.HasAPI(api) for prim in prims)
        joints = [prim for prim in prims if prim.IsA(UsdPhysics.Joint)]
        mass = {prim.GetName(): UsdPhysics.MassAPI(prim).GetMassAttr().Get() for prim in prims if prim.HasAPI(UsdPhysics.MassAPI)}
        told = dict(bodies=count(UsdPhysics.RigidBodyAPI), colliders=count(UsdPhysics.CollisionAPI), joints=len(joints), mass_kg=mass)
        print(json.dumps({"file": path, **told}))


def validated(stage):
    registry = UsdValidation.ValidationRegistry()
    validators = registry.GetOrLoadAllValidators()
    return UsdValidation.ValidationContext(validators).Validate(stage)


if __name__ == "__main__":
    main()
