"""Does the shards of a batch as job arrays of Slurm. It needs sbatch, squeue and scontrol, and no accounting database.

What is done is told by the files of the shards and not by Slurm: with accounting off, a controller forgets jobs some minutes after
they have ended, and one that was killed forgets what happened in its last seconds. A task that Slurm runs twice does nothing the
second time, since a shard is locked while it is done.
"""

import pathlib
import re
import shlex
import subprocess
import sys
import time

from shared.files import write_whole
from shared.tools import Failed

from . import files, report

PROGRAM = pathlib.Path(__file__).resolve().parents[1] / "paint-batch"
ROUNDS = 4  # arrays that are sent, each for the shards that the ones before left undone
PATIENCE_S = 600  # for a controller that does not answer


def answer(*words):
    """(exit status, standard output and error) of a command of Slurm."""
    try:
        ran = subprocess.run(list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    except FileNotFoundError:
        raise Failed(f"{words[0]} is not in PATH: run this where Slurm's commands are (Debian: slurm-client)") from None
    return ran.returncode, ran.stdout.strip()


def undone(out, plan):
    """The numbers of the shards that are not done."""
    folders = report.shard_folders(out, plan)
    return [number for number, folder in enumerate(folders) if not (folder / "done.json").exists()]


def most_tasks():
    """How many tasks the controller allows in an array."""
    found = re.search(r"MaxArraySize\s*=\s*(\d+)", answer("scontrol", "show", "config")[1])
    return max(1, int(found[1]) - 1) if found else 1000


def tasks_of(plan, shards, task_s, most):
    """The shards as lists, one for each task of an array: as many of them as take about `task_s`, or more if there were more than
    `most` lists."""
    per_task = max(1, round(task_s / shard_seconds(plan)), -(-len(shards) // most))
    return [shards[i : i + per_task] for i in range(0, len(shards), per_task)]


def shard_seconds(plan):
    return max(1e-3, plan["estimate"]["work_s"] / len(plan["shards"]))


def duration(seconds):
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def tell_cost(plan, shards, tasks):
    work_s = shard_seconds(plan) * len(shards)
    print(f"cost: {len(shards)} of {len(plan['shards'])} shards in an array of {len(tasks)} tasks of about "
          f"{duration(work_s / len(tasks))}, {work_s / 3600:.2f} core-hours in all (measured on the machine that made the plan)",
          file=sys.stderr, flush=True)


def send(out, tasks, words):
    """Sends an array and returns its number. A controller that does not answer is asked again."""
    folder = out / "slurm"
    folder.mkdir(exist_ok=True)
    write_whole(folder / "tasks", "".join(" ".join(map(str, task)) + "\n" for task in tasks))
    script = folder / "task"
    write_whole(script, f"""#!/usr/bin/env bash
# Does the shards in the line of this task of the file "tasks", and goes on after one that fails.
status=0
for shard in $(sed -n "$((SLURM_ARRAY_TASK_ID + 1))p" {shlex.quote(str(folder / "tasks"))}); do
  {shlex.quote(str(PROGRAM))} shard {shlex.quote(str(out))} "$shard" || status=$?
done
exit "$status"
""")
    # The tasks of a node that fails are begun again by Slurm itself.
    command = ["sbatch", "--parsable", "--requeue", "--open-mode=append", "--cpus-per-task=1", "--job-name=paint-batch",
               f"--array=0-{len(tasks) - 1}", f"--output={folder}/%A_%a.log", *words, script]
    until = time.monotonic() + PATIENCE_S
    while True:
        status, said = answer(*command)
        number = said.split(";")[0].split("\n")[-1]
        if status == 0 and number.isdigit():
            return int(number)
        if answer("scontrol", "ping")[1].find("UP") >= 0 or time.monotonic() > until:
            raise Failed(f"sbatch: {said}")
        time.sleep(5)


def is_waiting_or_running(job):
    """Whether the controller still has tasks of this array to do; None where it does not answer."""
    status, said = answer("squeue", "-h", "-j", job, "-o", "%T %r")
    if status == 0:
        # Slurm holds a task whose node failed before it began, until somebody releases it. It is sent again here.
        left = said.splitlines()
        if left and all("launch failed" in line for line in left):
            answer("scancel", job)
            return False
        return bool(left)
    return False if "Invalid job id" in said else None


def wait(out, plan, job):
    """Waits until all shards are done or the array has ended."""
    silent_since = None
    while undone(out, plan):
        state = is_waiting_or_running(job)
        if state is False:
            return
        silent_since = (silent_since or time.monotonic()) if state is None else None
        if silent_since and time.monotonic() - silent_since > PATIENCE_S:
            raise Failed(f"the controller of Slurm has not answered for {PATIENCE_S} s: the same command goes on from here")
        time.sleep(min(30, max(1, shard_seconds(plan) / 10)))


def run(out, task_s, words):
    """Does the shards that are not done, merges the report and writes the book."""
    plan = files.read_plan(out)
    state, started = out / "slurm.json", time.monotonic()
    first = undone(out, plan)
    if state.exists() and first:  # an array that was sent before this command was interrupted
        wait(out, plan, files.read_json(state)["job"])
    for sent in range(ROUNDS):
        shards = undone(out, plan)
        if not shards:
            break
        tasks = tasks_of(plan, shards, task_s, most_tasks())
        if sent:
            print(f"{len(shards)} shards were not done and are sent again", file=sys.stderr, flush=True)
        tell_cost(plan, shards, tasks)
        job = send(out, tasks, words)
        files.write_json(state, {"job": job})
        wait(out, plan, job)
    left = undone(out, plan)
    if left:
        raise Failed(f"{len(left)} of {len(plan['shards'])} shards are not done after {ROUNDS} arrays, the first of them {left[0]}: "
                     f"see {out / 'slurm'}/*.log")
    report.merge(out)
    for chapter in range(report.chapters(plan)):
        report.book(out, chapter)
    spent_s = files.read_json(out / "times.json")["work_s"]
    print(f"cost: {spent_s / 3600:.2f} core-hours in tools, {plan['estimate']['work_s'] / 3600:.2f} estimated; "
          f"{duration(time.monotonic() - started)} since this command began", file=sys.stderr)
