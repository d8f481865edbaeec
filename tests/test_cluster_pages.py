"""Page on clusters: the manifest of Kubernetes."""

import pytest

from ballsocket.core.executors.dask import Distributed
from ballsocket.studies.file import read_study

from .places import ROOT, fenced

PAGE = ROOT / "docs" / "how-to" / "clusters.md"


def test_the_manifest_of_kubernetes_is_complete(tmp_path):
    yaml = pytest.importorskip("yaml")
    parts = list(yaml.safe_load_all(fenced(PAGE, "yaml")[0]))
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
    file.write_text(fenced(PAGE, "toml")[0], encoding="utf-8")
    port = kinds["Service", "scheduler"]["spec"]["ports"][0]["port"]
    assert read_study(file).engine == Distributed(address=f"tcp://scheduler:{port}")
    assert f"tcp://scheduler:{port}" in pods["Deployment", "worker"]["containers"][0]["command"]


@pytest.mark.parametrize("role", ["scheduler", "worker"])
def test_dask_has_the_options_of_the_manifest(role):
    yaml = pytest.importorskip("yaml")
    module = pytest.importorskip(f"distributed.cli.dask_{role}")
    parts = yaml.safe_load_all(fenced(PAGE, "yaml")[0])
    specs = [part["spec"]["template"]["spec"] for part in parts if part["kind"] == "Deployment"]
    command = next(words for spec in specs if (words := spec["containers"][0]["command"])[:2] == ["dask", role])
    options = {option for parameter in module.main.params for option in (*parameter.opts, *parameter.secondary_opts)}
    assert {word for word in command if word.startswith("--")} <= options
