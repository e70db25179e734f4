"""Laws of the A/A test: an alarm is counted as one, and the kept counts are as few as asked."""

import json
from pathlib import Path

from experiments.regression import reduce_run
from experiments.runs import load
from experiments.validation import aa
from tests.experiments.made_runs import LAWS, write_run
from tests.extent import exhaustive

ROOT = Path(__file__).parents[3]


def test_the_kept_a_a_test_raised_few_alarms() -> None:
    kept = json.loads((ROOT / aa.RESULT).read_text())
    pairs, interleaved = aa.sum_counts(kept["pairs"]), aa.sum_counts(kept["interleaved"])
    assert kept["dirty"] is False
    assert len(kept["pairs"]) >= 20
    assert len(kept["interleaved"]) >= 20
    assert pairs["comparisons"] >= 1000
    assert kept["comparisons"] == pairs["comparisons"] + interleaved["comparisons"]
    assert kept["alarms"] == pairs["alarms"] + interleaved["alarms"]
    assert kept["alarms"] <= aa.LARGEST_SHARE * kept["comparisons"]
    assert f"{pairs['alarms']} false alarms in {pairs['comparisons']:,}" in aa.in_words(kept)


@exhaustive
def test_a_run_of_slower_code_is_an_alarm_and_deterministic_counters_are_not_compared(
    tmp_path: Path,
) -> None:
    def law_of(structure, query, printed):
        return LAWS["O(n_t)"] if (structure, query) == ("half_edge", "face_faces") else None

    def of_one(experiment, structure):
        return structure == "half_edge"

    sound = reduce_run(load(write_run(tmp_path / "sound", only=of_one)))
    slow = reduce_run(load(write_run(tmp_path / "slow", law_of, of_one)))
    assert aa.compare_pair(sound, sound)["alarms"] == []
    row = aa.compare_pair(sound, slow)
    assert len(row["alarms"]) >= 3
    assert all("half_edge/face_faces" in it and " by work" not in it for it in row["alarms"])
    assert aa.sum_counts([row])["alarms"] == len(row["alarms"])
