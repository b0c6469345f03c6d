#!/usr/bin/env python3
"""Runs a server for hours under load: jobs, kills of the server and of jobs, a disk that fills, retention. At the end
nothing may be lost, doubled or half-written, and the server's memory must be flat. Prints a line a minute and a summary
of what was seen; ends with 1 if something was wrong.

  soak.py --program build/release/shadowbench [--hours 2] [--jobs 5000]

As root it mounts a small file system for the state folder, to fill it. Elsewhere give one with --state.
"""
import argparse, http.client, json, os, random, shutil, signal, subprocess, sys, tempfile, time

SCENARIO = {
    "name": "soak",
    "scene": {"objects": [{"type": "sphere", "centre": [0, 0, 0], "radius": 1, "opacity": 0.5}]},
    "lights": [{"type": "directional", "direction": [0, -1, 0]}],
    "rays": {"resolution": 8, "samples_per_pixel": 4},
    "receivers": {"type": "probes", "count": 200},
    "reference": {"samples_per_pixel": 16, "queries": 20, "spread_seeds": 2},
    "timing": {"repetitions": 1, "lookups": 64},
    "techniques": [{"type": "deep", "tolerance": 0.02}, {"type": "avsm"}],
}
SCENARIOS = 12  # different seeds of the truth
ENDED = ("succeeded", "failed", "cancelled")
KEEP = 400


def exact(result):
    """What of a result is the same on every run."""
    return [[cell[key] for key in ("technique", "label", "status", "bytes", "nodes", "curve_error", "lookup_error")]
            for variant in result["variants"] for light in variant["lights"] for cell in light["cells"]]


def subcommand(process):
    """The first argument of a process; empty where it has none, or is gone."""
    try:
        with open(f"/proc/{process}/cmdline") as file:
            return (file.read().split("\0") + [""])[1]
    except OSError:
        return ""


class Soak:
    def __init__(self, options):
        self.options = options
        self.random = random.Random(1)
        self.base = tempfile.mkdtemp(prefix="soak-")
        self.disk = options.state or os.path.join(self.base, "disk")
        self.mounted = False
        if not options.state and os.geteuid() == 0:
            os.makedirs(self.disk)
            self.mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=96m", "soak", self.disk]).returncode == 0
        self.state = os.path.join(self.disk, "state")
        self.log = os.path.join(self.base, "log")
        self.server = None
        self.jobs = {}      # id -> {"key", "scenario", "state", "checked"}
        self.keys = {}      # Idempotency-Key -> id
        self.open = set()   # ids that have not ended yet
        self.first = {}     # scenario -> exact numbers
        self.faults = []
        self.counts = dict(sent=0, repeated=0, refused=0, cancelled=0, retried=0, server_kills=0, job_kills=0, fills=0,
                           checked=0, removed=0, busy=0)
        self.memory = []    # (seconds, bytes resident, starts)
        self.starts = 0
        self.port = None
        self.begin = time.time()

    # --- the server
    def start(self):
        port_file = os.path.join(self.base, "port")
        if os.path.exists(port_file):
            os.remove(port_file)
        self.server = subprocess.Popen(
            [self.options.program, "serve", "--state", self.state, "--port", "0", "--port-file", port_file,
             "--keep-jobs", str(KEEP), "--min-free", "8", "--log-format", "json", "--parallel", "2", "--grace", "2"],
            stderr=open(self.log, "ab"), stdout=subprocess.DEVNULL)
        self.starts += 1
        for _ in range(600):
            if os.path.exists(port_file) and open(port_file).read().strip():
                self.port = int(open(port_file).read())
                return
            if self.server.poll() is not None:
                break
            time.sleep(0.1)
        raise SystemExit(f"soak: the server did not start; see {self.log}")

    def ask(self, method, path, body=None, key=None):
        """(status, JSON or None); status 0 where no server answers."""
        head = {"Content-Type": "application/json"}
        if key:
            head["Idempotency-Key"] = key
        try:
            connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
            connection.request(method, path, json.dumps(body) if body is not None else None, head)
            answer = connection.getresponse()
            text = answer.read()
            connection.close()
        except OSError:
            return 0, None
        except http.client.HTTPException:
            return 0, None
        try:
            return answer.status, json.loads(text)
        except ValueError:
            return answer.status, None

    def fault(self, text):
        self.faults.append(f"{time.time() - self.begin:.0f} s: {text}")
        print("soak: FAULT", self.faults[-1], flush=True)

    # --- jobs
    def post(self, key, scenario):
        body = dict(SCENARIO, reference=dict(SCENARIO["reference"], seed=scenario + 1))
        return self.ask("POST", "/v1/jobs", {"scenario": body, "options": {
            "cache": "fresh", "pictures": False, "labels": [f"s{scenario}"]}}, key)

    def send(self):
        number = self.counts["sent"]
        scenario = number % SCENARIOS
        key = f"soak-{number}"
        status, answer = self.post(key, scenario)
        if status in (200, 202):
            self.took(key, answer["id"], scenario)
            self.counts["sent"] += 1
        elif status in (0, 429, 503, 507):
            self.counts["refused"] += 1  # the same key is sent again later: what was stored comes back
        else:
            self.fault(f"POST /v1/jobs: {status} {answer}")

    def took(self, key, job, scenario):
        if self.keys.get(key, job) != job:
            self.fault(f"key {key} has two jobs: {self.keys[key]} and {job}")
        if job in self.jobs and self.jobs[job]["key"] != key:
            self.fault(f"job {job} has two keys")
        self.keys[key] = job
        if job not in self.jobs:
            self.jobs[job] = {"key": key, "scenario": scenario, "state": "queued", "cancel": False}
            self.open.add(job)

    def poll(self):
        """Looks at the jobs that have not ended, the oldest first."""
        for job in sorted(self.open, key=lambda j: int(self.jobs[j]["key"].split("-")[1]))[:12]:
            status, answer = self.ask("GET", f"/v1/jobs/{job}")
            if status in (0, 503):
                self.counts["busy"] += 1
                return
            if status != 200 or answer is None:
                gone = "is gone, and was never seen to end" if status == 404 else f"answers {status}"
                self.fault(f"job {job} ({self.jobs[job]['key']}) {gone}")
                self.open.discard(job)
                continue
            state = answer["state"]
            self.jobs[job]["state"] = state
            if state not in ENDED:
                continue
            if state == "failed":
                self.fault(f"job {job} failed: {answer.get('error')}")
            if state == "cancelled" and not self.jobs[job]["cancel"]:
                self.fault(f"job {job} is cancelled, and nobody asked for it")
            if state == "succeeded" and not self.check(job):
                continue  # asked again later
            self.open.discard(job)

    def check(self, job):
        status, result = self.ask("GET", f"/v1/jobs/{job}/result")
        if status in (0, 503):
            return False
        if status != 200 or result is None:
            self.fault(f"the result of {job}: {status}")
            return True
        numbers = exact(result)
        scenario = self.jobs[job]["scenario"]
        if self.first.setdefault(scenario, numbers) != numbers:
            self.fault(f"job {job} has other numbers than the first job of its scenario")
        self.counts["checked"] += 1
        return True

    def disturb(self):
        """Now and then: the same key again, a cancelled job, one that is queued anew, a list."""
        chance = self.random.random()
        if chance < 0.03 and self.keys:
            key = self.random.choice(list(self.keys)[-200:])
            scenario = self.jobs[self.keys[key]]["scenario"]
            status, answer = self.post(key, scenario)
            if status in (200, 202):
                self.took(key, answer["id"], scenario)
                self.counts["repeated"] += 1
        elif chance < 0.05 and self.open:
            job = self.random.choice(sorted(self.open))
            status, _ = self.ask("POST", f"/v1/jobs/{job}/cancel")
            if status:
                self.jobs[job]["cancel"] = True
                self.counts["cancelled"] += status in (200, 202)
        elif chance < 0.06:
            ended = [j for j in list(self.jobs)[-100:] if self.jobs[j]["state"] == "cancelled"]
            if ended:
                job = self.random.choice(ended)
                status, _ = self.ask("POST", f"/v1/jobs/{job}/retry")
                if status in (200, 202):
                    self.open.add(job)
                    self.counts["retried"] += 1
        elif chance < 0.10:
            self.ask("GET", "/v1/jobs?limit=50")
            self.ask("GET", "/metrics")

    # --- what goes wrong
    def kill_server(self):
        self.server.kill()
        self.server.wait()
        self.counts["server_kills"] += 1
        self.start()

    def kill_job(self):
        """Kills a process that runs a job, if there is one. Other children check scenarios, or wait for the end."""
        found = subprocess.run(["pgrep", "-P", str(self.server.pid)], capture_output=True, text=True).stdout.split()
        jobs = [int(child) for child in found if subcommand(child) == "job"]
        if jobs:
            try:
                os.kill(jobs[-1], signal.SIGKILL)
                self.counts["job_kills"] += 1
            except OSError:
                pass

    def fill(self, seconds):
        """Fills the disk; the server must say so, keep what it has, and go on by itself."""
        filler = os.path.join(self.disk, "filler")
        with open(filler, "wb") as file:
            try:
                while True:
                    file.write(b"x" * 65536)
                    file.flush()
            except OSError:
                pass
        end = time.time() + seconds
        ready = []
        while time.time() < end:
            self.send()
            self.poll()
            ready.append(self.ask("GET", "/readyz")[0])
            time.sleep(0.5)
        if 503 not in ready:
            self.fault("the disk was full, and /readyz never said so")
        os.remove(filler)
        self.counts["fills"] += 1
        for _ in range(120):
            if self.ask("GET", "/readyz")[0] == 200:
                return
            time.sleep(0.5)
        self.fault("/readyz did not become 200 within 60 s of the disk having room")

    def resident(self):
        with open(f"/proc/{self.server.pid}/status") as file:
            for line in file:
                if line.startswith("VmRSS"):
                    return int(line.split()[1]) * 1024
        return 0

    def run(self):
        seconds = self.options.hours * 3600
        self.start()
        # The first half has the kills and the full disks, the second shows the memory of one server.
        plan = [(when, self.kill_server) for when in range(90, int(seconds / 2), 90)]
        plan += [(when, self.kill_job) for when in range(50, int(seconds * 0.9), 110)]
        if self.mounted or self.options.state:
            plan += [(seconds * part, lambda: self.fill(60)) for part in (0.2, 0.7)]
        plan.sort(key=lambda step: step[0])
        said = 0.0
        while True:
            now = time.time() - self.begin
            if now >= seconds:
                break
            while plan and plan[0][0] <= now:
                plan.pop(0)[1]()
            due = self.options.jobs * now / seconds / 0.97
            if self.counts["sent"] < min(due, self.options.jobs) and len(self.open) < 300:
                self.send()
            self.disturb()
            self.poll()
            if now - said >= 60:
                said = now
                if self.server.poll() is not None:
                    self.fault(f"the server ended by itself with {self.server.returncode}")
                    self.start()
                self.memory.append((now, self.resident(), self.starts))
                print(f"soak: {now:.0f} s, {self.counts}, open {len(self.open)}, "
                      f"resident {self.memory[-1][1] / 2**20:.1f} MiB", flush=True)
            time.sleep(0.15)
        self.finish()

    def finish(self):
        end = time.time() + 600
        while self.open and time.time() < end:
            self.poll()
            time.sleep(0.2)
        for job in self.open:
            self.fault(f"job {job} never ended: {self.jobs[job]['state']}")
        self.server.send_signal(signal.SIGTERM)
        code = self.server.wait()
        if code != 0:
            self.fault(f"the server ended with {code}")
        removed = set()
        with open(self.log) as file:
            for line in file:
                try:
                    entry = json.loads(line)
                except ValueError:
                    continue  # the last line of a server that was killed
                if entry.get("event") == "job" and entry.get("message") == "removed":
                    removed.add(entry["job"])
        self.counts["removed"] = len(removed)
        self.start()
        left = self.listed()
        for job in self.jobs:
            if job not in left and job not in removed:
                self.fault(f"job {job} is neither there nor removed")
        for job in left - set(self.jobs):
            self.fault(f"job {job} is there, and was never sent")
        if len(left) > KEEP:
            self.fault(f"{len(left)} jobs are kept; --keep-jobs says {KEEP}")
        self.server.terminate()
        self.server.wait()
        check = subprocess.run([self.options.program, "serve", "fsck", "--state", self.state], capture_output=True,
                               text=True)
        if check.returncode:
            self.fault(f"fsck: {check.stdout} {check.stderr}")
        last = [bytes_ for _, bytes_, start in self.memory if start == self.memory[-1][2]] if self.memory else []
        print("soak: seconds", round(time.time() - self.begin), "counts", self.counts, "jobs", len(self.jobs))
        if len(last) > 3:
            print("soak: the last server's resident MiB after 1 minute, in the middle, at the end: "
                  f"{last[1] / 2**20:.1f} {last[len(last) // 2] / 2**20:.1f} {last[-1] / 2**20:.1f}; most "
                  f"{max(last) / 2**20:.1f}")
            if last[-1] > 1.2 * last[len(last) // 4] + 2**23:
                self.fault("the server's memory grew by more than a fifth and 8 MiB over three quarters of its life")
        print("soak:", f"{len(self.faults)} faults" if self.faults else "nothing lost, nothing doubled")
        if self.faults:
            print("soak: the log is", self.log)

    def close(self):
        """Ends the server and gives back the disk, whatever happened; the folder with the log stays after a fault."""
        if self.server and self.server.poll() is None:
            self.server.kill()
            self.server.wait()
        if self.mounted:
            subprocess.run(["umount", self.disk])
        if not self.faults:
            shutil.rmtree(self.base, ignore_errors=True)

    def listed(self):
        found, cursor = set(), ""
        while True:
            status, answer = self.ask("GET", "/v1/jobs?limit=100" + cursor)
            if status != 200:
                self.fault(f"the list of jobs: {status}")
                return found
            found.update(job["id"] for job in answer["jobs"])
            if not answer.get("next"):
                return found
            cursor = "&cursor=" + str(answer["next"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--hours", type=float, default=2)
    parser.add_argument("--jobs", type=int, default=5000)
    parser.add_argument("--state", help="a folder on a small file system [a tmpfs of 96 MiB, mounted by root]")
    soak = Soak(parser.parse_args())
    try:
        soak.run()
    except BaseException:
        soak.faults.append("the soak itself ended early")
        raise
    finally:
        soak.close()
    sys.exit(1 if soak.faults else 0)


if __name__ == "__main__":
    main()
