"""A study spreads over the machines of a cluster, each kept apart, and outlives one of them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

from experiments.runs import cluster, study, worker
from experiments.runs.machine_task import VARIABLE, AbandonedError, Task, perform
from experiments.runs.results import load, read_json
from tests.experiments.cli.test_cli import hem
from tests.experiments.small_study import begin, samples, wait_for

SMOKE = worker.How("smoke")


@pytest.fixture(scope="module")
def two_machines():
    """The address of a cluster of two workers that pass for two machines, and their processes."""
    distributed = pytest.importorskip("distributed")
    local = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    with local, distributed.Client(local, set_as_default=False) as client:
        for name, worker in enumerate(client.ncores()):
            client.run(lambda it: os.environ.update({VARIABLE: it}), str(name), workers=[worker])
        yield local.scheduler_address, list(client.run(os.getpid).values())


def test_an_interrupted_study_goes_on_with_what_its_machines_have_measured(
    tmp_path, monkeypatch, two_machines
):
    address, _ = two_machines
    folder = begin(tmp_path)
    script = (
        "import sys; from pathlib import Path; from experiments import cluster, study\n"
        "study.EXPERIMENTS = ('bench_work',)\n"
        "cluster.run(Path(sys.argv[1]), 'smoke', sys.argv[2], lambda p, n: None, ['indexed'])"
    )
    command = [sys.executable, "-c", script, str(folder), address]
    caller = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: samples(folder))
    caller.send_signal(signal.SIGINT)
    _, said = caller.communicate(timeout=30)
    before = samples(folder)
    assert "KeyboardInterrupt" in said
    assert "finished" not in read_json(folder / "run.json")
    monkeypatch.setattr(study, "EXPERIMENTS", ("bench_work",))
    cluster.run(folder, "smoke", address, lambda process, done: None, ["indexed"], print)
    after = samples(folder)
    assert before.items() <= after.items()
    assert len(after) == sum(len(it.cases) for it in study.processes("smoke", ["indexed"]))
    assert len(load(folder).meta["resumed"]) == 1


def test_work_is_spread_kept_apart_and_tried_elsewhere_when_a_machine_is_lost(
    tmp_path, monkeypatch, two_machines
):
    monkeypatch.setattr(study, "EXPERIMENTS", ("bench_latency", "bench_memory"))
    structures = ["indexed", "half_edge"]
    folder = begin(tmp_path)
    said: list[str] = []
    address, workers = two_machines

    def lose_one(process: study.Process, done: int) -> None:
        if done and len(workers) == 2:
            os.kill(workers.pop(), signal.SIGKILL)

    cluster.run(folder, "smoke", address, lose_one, structures, said.append)
    run = load(folder)
    every = study.processes("smoke", structures)
    found = run.cases.groupby(["experiment", "structure"])
    assert {key: len(cases) for key, cases in found} == {
        (it.experiment, it.structure): len(it.cases) for it in every
    }
    assert (found["machine"].nunique() == 1).all()
    assert len(said) == 1
    assert "its worker was lost" in said[0]
    machines = sorted(folder.glob("machine-*"))
    assert len(machines) >= 2
    for machine in machines:
        about = read_json(machine / "run.json")
        assert about["profile"] == "smoke"
        assert about["machine"]["cores"] == os.cpu_count()
    assert "finished" in run.meta
    used = {name.removeprefix("machine-") for name in run.cases["machine"]}
    assert set(run.machines) == (used if len(used) > 1 else set())


def test_a_machine_gives_up_what_nobody_wants_and_is_free_again(tmp_path):
    task = Task("bench_memory", "indexed", SMOKE)
    with pytest.raises(AbandonedError, match="not wanted"):
        perform(task, tmp_path.name, lambda: False, lambda text: None)
    asked: list[int] = []

    def for_a_while() -> bool:
        asked.append(0)
        return len(asked) < 3

    with pytest.raises(AbandonedError):
        perform(task, tmp_path.name, for_a_while, lambda text: None)


def test_a_run_of_a_cluster_is_not_gone_on_with_by_this_machine_alone(tmp_path):
    folder = begin(tmp_path)
    (folder / "machine-0").mkdir()
    code, output = hem("study", "--resume", "--run", str(folder))
    assert (code, "resume it with --workers" in output) == (1, True)


def test_without_dask_it_is_said_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, output = hem("study", "--workers", "tcp://localhost:1", "--output", str(tmp_path))
    assert (code, "pip install 'hem[cluster]'" in output) == (1, True)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense", "tcp://"])
def test_without_a_cluster_it_is_said_how_to_start_one(tmp_path, monkeypatch, address):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 1)
    code, output = hem("study", "--workers", address, "--output", str(tmp_path))
    assert (code, "dask scheduler" in output) == (1, True), output
    assert output.startswith(f"hem: no cluster answers at {address}")
    assert list(tmp_path.iterdir()) == []
