#!/usr/bin/env python3
"""Compares what the server estimates for scenarios with the time that they take: runs each, draws its pictures, and
prints estimate, processor time and their ratio. Ends with 1 if a ratio is beyond the factor or a command fails.

  estimates.py --program build/release/shadowbench [--data DIR] [--factor 3] [--no-pictures] SCENARIO...

All of it runs on one processor, so that the estimate, which is for the processors that there are, is one of processor
time; what else the machine does then matters little. Scenarios whose data are missing are skipped, and so are those
that are estimated to take more than --longest seconds.
"""
import argparse, json, os, pathlib, subprocess, sys, tempfile, time


def examine(options, document):
    """The estimate of the server, or why there is none."""
    words = [options.program, "examine"] + [word for folder in options.data for word in ("--data", folder)]
    done = subprocess.run(words, input=json.dumps(document) + "\n", capture_output=True, text=True)
    answer = json.loads(done.stdout)
    if "estimate" in answer:
        return answer["estimate"], ""
    return None, (answer.get("error") or answer["faults"][0])["message"]


def measure(options, command, scenario):
    """Processor and wall seconds of a command, and whether it ended well."""
    with tempfile.TemporaryDirectory() as out:
        words = [options.program, command, scenario, "--out", out] + [
            word for folder in options.data for word in ("--data", folder)]
        begin = time.monotonic()
        child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        return usage.ru_utime + usage.ru_stime, time.monotonic() - begin, child.returncode in (0, 2)  # 2: a broken promise


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--data", action="append", default=[])
    parser.add_argument("--factor", type=float, default=3.0)
    parser.add_argument("--longest", type=float, default=120.0)
    parser.add_argument("--pictures", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("scenarios", nargs="+")
    options = parser.parse_args()
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})

    beyond = 0
    print(f"{'scenario':32}{'what':10}{'estimate':>10}{'processor':>10}{'wall':>10}{'ratio':>8}", flush=True)
    for scenario in options.scenarios:
        name = pathlib.Path(scenario).stem
        estimate, why = examine(options, json.loads(pathlib.Path(scenario).read_text()))
        if not estimate:
            print(f"{name:32}skipped: {why}", flush=True)
            continue
        for command, key in (("run", "seconds"), ("render", "picture_seconds")):
            expected = estimate[key]
            if not expected or (command == "render" and not options.pictures):
                continue
            if expected > options.longest:
                print(f"{name:32}{command:10}{expected:10.2f}  skipped: longer than {options.longest:g} s", flush=True)
                continue
            seconds, wall, well = measure(options, command, scenario)
            ratio = expected / seconds
            bad = not well or not 1 / options.factor <= ratio <= options.factor
            beyond += bad
            print(f"{name:32}{command:10}{expected:10.2f}{seconds:10.2f}{wall:10.2f}{ratio:8.2f}"
                  f"{' beyond' if bad else ''}{'' if well else ' failed'}", flush=True)
    return beyond > 0


if __name__ == "__main__":
    sys.exit(main())
