"""The files for engines that cannot be run here in full, held against what their makers publish, and their commands run."""

import json
import subprocess
import time
from pathlib import Path

from farm import FarmError, audit


def say(words, what, env=None):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, env=env)
    if done.returncode:
        raise FarmError(f"{what}: {(done.stdout + done.stderr).strip()}")
    return done.stdout


def openjd(farm, python, folder):
    """`openjd check` accepts the template, and `openjd run` makes the dataset by it."""
    job = farm.new_job(folder / "job")
    farm.run("farm", "submit", str(job), "--engine", "openjd", "--program", farm.program, "-o", str(folder))
    program, template = Path(python).with_name("openjd"), folder / "template.json"
    say([program, "check", template, "--extensions", "TASK_CHUNKING"], "openjd refuses the template")
    out, begun = folder / "dataset", time.monotonic()
    words = ["run", template, "--extensions", "TASK_CHUNKING", "--step", "Collect", "--run-dependencies", "-p", f"Dataset={out}"]
    say([program, *words], "openjd cannot run the template")
    farm.judge(job, out, collect=False)
    return {**audit(job), "seconds": round(time.monotonic() - begun, 1), "version": version(python, "openjd-cli")}


def kubernetes(farm, python, folder):
    """The manifest is valid by Kubernetes' own schema; its command, once per index, does the missing tasks."""
    job = farm.new_job(folder / "job")
    farm.run("farm", "submit", str(job), "--engine", "kubernetes", "--program", farm.program, "--image", "registry/enfilade:1", "-o", str(folder))
    (manifest,) = folder.glob("*.job.json")
    say([Path(python).with_name("kubernetes-validate"), "--strict", manifest], "kubernetes-validate refuses the manifest")
    spec = json.loads(manifest.read_text())["spec"]
    container = spec["template"]["spec"]["containers"][0]
    begun = time.monotonic()
    run_indices(container["command"], "JOB_COMPLETION_INDEX", spec["completions"], folder)
    farm.judge(job, folder / "dataset")
    return {**audit(job), "seconds": round(time.monotonic() - begun, 1), "version": version(python, "kubernetes-validate")}


def aws_batch(farm, python, folder):
    """The requests have the shape that AWS publishes for `SubmitJob`; their command, once per index, does the missing tasks."""
    job = farm.new_job(folder / "job")
    farm.run("farm", "submit", str(job), "--engine", "aws-batch", "--program", farm.program, "--queue", "spot", "--definition", "enfilade:1", "-o", str(folder))
    (path,) = folder.glob("*.batch.json")
    say([python, "-c", CHECK_BATCH, path], "botocore refuses the request")
    request = json.loads(path.read_text())
    overrides = request["containerOverrides"]
    begun = time.monotonic()
    run_indices(overrides["command"], "AWS_BATCH_JOB_ARRAY_INDEX", request["arrayProperties"]["size"], folder)
    farm.judge(job, folder / "dataset")
    return {**audit(job), "seconds": round(time.monotonic() - begun, 1), "version": version(python, "botocore")}


CHECK_BATCH = """
import json, sys, botocore.session, botocore.validate
shape = botocore.session.get_session().get_service_model("batch").operation_model("SubmitJob").input_shape
report = botocore.validate.ParamValidator().validate(json.load(open(sys.argv[1])), shape)
sys.exit(report.generate_report() if report.has_errors() else 0)
"""


def run_indices(command, variable, count, folder):
    """Runs a container's command for every index, with a scratch folder of this test's own."""
    words = [*command[:-1], str(folder / "scratch")]
    assert command[-2] == "--scratch", command
    for index in range(count):
        say(words, f"index {index}", env={"PATH": "/usr/bin:/bin", variable: str(index)})


def version(python, package):
    return say([python, "-c", f"import importlib.metadata; print(importlib.metadata.version('{package}'))"], package).strip()


ENGINES = [
    ("OpenJD", "`openjd check`, then `openjd run` of both steps", openjd),
    ("Kubernetes", "`kubernetes-validate --strict`, then the container's command once per index", kubernetes),
    ("AWS Batch", "botocore's model of `SubmitJob`, then the container's command once per index", aws_batch),
]
