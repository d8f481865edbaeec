"""Pages on clusters: the submit script of SLURM by a dry run, and the manifest of Kubernetes."""

import os
import re
import stat
import subprocess
import sys

import pytest

import ballsocket as bs
from ballsocket.core.executors.dask import Distributed
from ballsocket.studies.file import read_study

from .places import ROOT
from .processes import PATIENCE

HOW_TO = ROOT / "docs" / "how-to"


def blocks(page, language):
    text = (HOW_TO / page).read_text("utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, flags=re.MULTILINE | re.DOTALL)


SLURM_PROGRAM = blocks("clusters.md", "text")[0]


PROGRAMS = {
    "sbatch": 'cp "$1" submitted.sh\nsh "$1" > worker.log 2>&1 &\necho $! >> jobs\necho "Submitted batch job 7"\n',
    "scancel": "kill $(cat jobs) 2> /dev/null\n",
}


def encrypted(folder):
    """Return the program with the lines of the page that encrypt the ports, and certificates in a folder."""
    page = (HOW_TO / "clusters.md").read_text("utf-8")
    lines = re.search(r"^  ```text\n(.*?)^  ```$", page, flags=re.MULTILINE | re.DOTALL)[1]
    security, cluster, engine = (line.strip() for line in lines.splitlines())
    options = cluster.removeprefix("cluster = SLURMCluster(").removesuffix(", ...)").replace("/home/me", str(folder))
    start = "    cluster = SLURMCluster("
    program = SLURM_PROGRAM.replace(start, f"    {security}\n{start}{options},")
    return "import distributed\n" + re.sub(r"engine = Distributed\(.*\)", engine, program)


@pytest.mark.long
@pytest.mark.parametrize(("program", "protocol"), [(lambda _: SLURM_PROGRAM, "tcp://"), (encrypted, "tls://")])
def test_the_program_of_the_page_runs_where_sbatch_is_a_shell(tmp_path, program, protocol):
    """A job starts at once, as a process of this machine, with one core and few points."""
    pytest.importorskip("dask_jobqueue")
    for name, text in PROGRAMS.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}", encoding="utf-8")
        (tmp_path / name).chmod(stat.S_IRWXU)
    (tmp_path / "certificates").mkdir()
    text = program(tmp_path).replace("cores=32", "cores=1").replace("processes=32", "processes=1")
    text = text.replace("jobs=8", "jobs=1").replace(", 100)", ", 3)").replace("64GB", "1GB")
    text = text.replace("walltime=", "scheduler_options={'host': '127.0.0.1'}, walltime=")
    (tmp_path / "run_study.py").write_text(text, encoding="utf-8")
    variables = {**os.environ, "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}"}
    words, pipes = [sys.executable, "run_study.py"], {"capture_output": True, "text": True}
    done = subprocess.run(words, cwd=tmp_path, env=variables, timeout=PATIENCE, **pipes)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    submitted = (tmp_path / "submitted.sh").read_text(encoding="utf-8")
    assert "#SBATCH -p compute" in submitted
    assert protocol in submitted
    assert bs.studies.read(tmp_path / "hips.zarr").max_pressure.shape == (3, 3, 3)


def test_the_manifest_of_kubernetes_is_complete(tmp_path):
    yaml = pytest.importorskip("yaml")
    parts = list(yaml.safe_load_all(blocks("clusters.md", "yaml")[0]))
    kinds = {(part["kind"], part["metadata"]["name"]): part for part in parts}
    deployments = {("Deployment", "scheduler"), ("Deployment", "worker")}
    assert set(kinds) == {("PersistentVolumeClaim", "hips"), ("Service", "scheduler"), ("Job", "study"), *deployments}
    pods = {name: part["spec"]["template"]["spec"] for name, part in kinds.items() if "template" in part["spec"]}
    images = {container["image"] for pod in pods.values() for container in pod["containers"]}
    assert images == {"registry.example.org/ballsocket:1"}
    for deployment in deployments:
        spec = kinds[deployment]["spec"]
        assert spec["selector"]["matchLabels"] == spec["template"]["metadata"]["labels"]
    assert kinds["Service", "scheduler"]["spec"]["selector"] == {"app": "scheduler"}
    for name in (("Deployment", "worker"), ("Job", "study")):
        mounts = {mount["name"]: mount["mountPath"] for mount in pods[name]["containers"][0]["volumeMounts"]}
        assert mounts["hips"] == "/hips"
    file = tmp_path / "study.toml"
    file.write_text(blocks("clusters.md", "toml")[0], encoding="utf-8")
    port = kinds["Service", "scheduler"]["spec"]["ports"][0]["port"]
    assert read_study(file).engine == Distributed(address=f"tcp://scheduler:{port}")
    assert f"tcp://scheduler:{port}" in pods["Deployment", "worker"]["containers"][0]["command"]


@pytest.mark.parametrize("role", ["scheduler", "worker"])
def test_dask_has_the_options_of_the_manifest(role):
    yaml = pytest.importorskip("yaml")
    module = pytest.importorskip(f"distributed.cli.dask_{role}")
    parts = yaml.safe_load_all(blocks("clusters.md", "yaml")[0])
    specs = [part["spec"]["template"]["spec"] for part in parts if part["kind"] == "Deployment"]
    command = next(words for spec in specs if (words := spec["containers"][0]["command"])[:2] == ["dask", role])
    options = {option for parameter in module.main.params for option in (*parameter.opts, *parameter.secondary_opts)}
    assert {word for word in command if word.startswith("--")} <= options
