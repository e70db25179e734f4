"""A study spreads over the machines of a cluster, each kept apart, and outlives one of them."""

import os
import signal
import sys
from unittest.mock import MagicMock

import pytest

from experiments.harness import Measurement
from experiments.runs import cluster, load, read_meta, study, write_meta
from experiments.runs.worker import Job
from tests.experiments.cli.calls import hem
from tests.experiments.small_study import PATIENCE_SECONDS, Recorder, begin, in_new_process, samples
from tests.extent import exhaustive, waiting_for


@pytest.fixture(scope="module")
def two_machines():
    """The address of a cluster of two workers that pass for two machines, and their processes."""
    distributed = pytest.importorskip("distributed")
    local = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
        resources={"machine": 1},
    )  # fmt: skip
    with local, distributed.Client(local, timeout=PATIENCE_SECONDS, set_as_default=False) as client:
        for name, worker in enumerate(client.ncores()):
            set_name = {cluster.VARIABLE: str(name)}
            client.run(lambda it: os.environ.update(it), set_name, workers=[worker])
        yield local.scheduler_address, list(client.run(os.getpid).values())


@pytest.fixture(autouse=True)
def _patient(monkeypatch):
    """A scheduler on a busy machine is a while in answering."""
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", PATIENCE_SECONDS)


@exhaustive
def test_an_interrupted_study_is_resumed_with_what_its_machines_have_measured(
    tmp_path, two_machines
):
    address, _ = two_machines
    folder = begin(tmp_path, "latency", "work")
    script = f"cluster.CONNECT_SECONDS = {PATIENCE_SECONDS}\n"
    script += "cluster.run(folder, sys.argv[2], Prints())"
    with in_new_process(script, folder, address) as caller:
        caller.stdout.readline()
        caller.send_signal(signal.SIGINT)
        _, said = caller.communicate()
    before = samples(folder)
    assert "KeyboardInterrupt" in said
    assert before
    cluster.run(folder, address)
    after = samples(folder)
    assert before.items() <= after.items()
    assert len(after) == sum(len(job.ids) for job in study.plan(folder))
    assert len(load(folder).meta["resumed"]) == 1


@exhaustive
def test_work_is_spread_kept_apart_and_tried_elsewhere_when_a_machine_is_lost(
    tmp_path, two_machines
):
    folder = begin(tmp_path, "latency", "memory", structures=["indexed", "half_edge"])
    address, workers = two_machines

    def lose_one(job: Job, done: int) -> None:
        if len(workers) == 2:
            os.kill(workers.pop(), signal.SIGKILL)

    cluster.run(folder, address, Recorder(lose_one))
    run = load(folder)
    found = run.cases.groupby(["experiment", "structure"])
    expected = {(it.experiment, it.structure): len(it.ids) for it in study.plan(folder)}
    assert {key: len(cases) for key, cases in found} == expected
    assert (found["machine"].nunique() == 1).all()
    for machine in folder.glob("machine-*"):
        about = read_meta(machine)
        assert (about["preset"], about["machine"]["cores"]) == ("smoke", os.cpu_count())
    used = {name.removeprefix("machine-") for name in run.cases["machine"]}
    assert set(run.machines) == (used if len(used) > 1 else set())


@pytest.mark.parametrize(("begun", "several"), [("", 2), ("machine-b", 0)])
def test_times_of_a_run_that_was_begun_here_and_finished_elsewhere_do_not_mix(
    tmp_path, monkeypatch, begun, several
):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "_client", lambda address: MagicMock())
    folder = begin(tmp_path, "latency", "memory")
    idle, busy = folder / "machine-a", folder / "machine-b"
    for place in (idle, busy):
        write_meta(place, {**cluster.describe("smoke"), "host": place.name})
    for place, job in zip((begun, busy), study.plan(folder), strict=True):
        job.file(folder / place).add(*(Measurement(it, "time", samples=[1.0]) for it in job.ids))
        job.file(idle).path.touch()  # where it failed at once
    cluster.run(folder, "tcp://nobody:1")
    assert len(load(folder).machines) == several


def test_a_machine_measures_only_what_is_wanted_by_the_same_code(tmp_path):
    job = Job("bench_memory", "indexed", "smoke")
    commit = cluster.describe("smoke")["commit"]
    with pytest.raises(cluster.ClusterError, match="bring them to the same"):
        cluster.measure_alone(job, "0123456789", lambda: True)
    for _ in range(2):  # and is free again
        with pytest.raises(cluster.ClusterError, match="not wanted"):
            cluster.measure_alone(job, commit, lambda: False)


def test_a_run_of_a_cluster_is_not_resumed_by_this_machine_alone(tmp_path):
    folder = begin(tmp_path)
    (folder / "machine-0").mkdir()
    code, output = hem("study", "--resume", "--run", str(folder))
    assert (code, "resume it with --workers" in output) == (1, True)


def test_without_dask_it_is_said_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, output = hem("study", "--workers", "tcp://localhost:1", "--output", str(tmp_path))
    assert (code, "pip install 'hem-mesh[cluster]'" in output) == (1, True)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "address",
    waiting_for(["tcp://127.0.0.1:1"], ["tcp://127.0.0.1:1", "nonsense", "tcp://"]),
)
def test_without_a_cluster_it_is_said_how_to_start_one(tmp_path, monkeypatch, address):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 1)
    code, output = hem("study", "--workers", address, "--output", str(tmp_path))
    assert (code, "dask scheduler" in output) == (1, True), output
    assert output.startswith(f"hem: no cluster answers at {address}")
    assert list(tmp_path.iterdir()) == []
