"""The process of a worker, as ``worker.perform`` starts it."""

import json
import sys

from experiments.runs.worker import main

raise SystemExit(main(json.loads(sys.argv[1])))
