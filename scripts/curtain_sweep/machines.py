# SPDX-License-Identifier: BSD-3-Clause
"""Who makes the runs: GNU parallel, with curtain_batch on this machine or on others over ssh. Its job log says which runs have been
made; it resumes, retries, transfers files, and shows progress and the time left.

What a run comes to is its result, also when the scene is at fault: exit codes 2 and 3 of curtain_batch, and a crash. What keeps a
run from being made is not: a full disk, a machine that is gone, a kill. Then the job fails, for parallel to try it again elsewhere,
or, with the same command, another time.
"""
import os
import re
import shlex
import shutil
import signal
import subprocess

from curtain_sweep.problem import Problem

# Never asks for a password, and gives up a machine that has gone silent.
SSH = "-o BatchMode=yes -o ConnectTimeout=10 -o ServerAliveInterval=15"
FIND = 'batch=%s; [ -x "$batch" ] || batch=curtain_batch; '
# $1: name of the run. Where the machine of the sweep is one of several (":"), nothing is brought to it: it works in the sweep's own
# folder. 132 to 136 and 139: the program crashed.
JOB = FIND + '''[ -e "$1.yaml" ] || { rmdir "$PWD"; cd %s || exit 4; }
said=$("$batch" "$1.yaml" --duration %s --stats "$1.result" %s 2>&1)
code=$?
case $code in
  0) exit 0 ;;
  2 | 3 | 13[2-6] | 139) printf "exit %%s\\n%%s\\n" $code "$said" >"$1.result"%s && exit 0 ;;
esac
printf "run %%s: exit code %%s: %%s\\n" "$1" $code "$said" >&2
exit $code'''
TRIES = 3  # of a run that could not be made, where there are other machines to try
FAILED = 3  # runs that could not be made end the sweep: the next ones would hardly fare better


def find_batch(given, scripts):
    """curtain_batch: the one given, or installed beside the scripts, or built in the checkout, or on the PATH."""
    root = os.path.dirname(scripts)
    places = [given] if given else [os.path.join(scripts, "curtain_batch"), os.path.join(root, "build/devel/lib/curtain_sim/curtain_batch"),
                                    os.path.join(root, "build-engine/curtain_batch"), shutil.which("curtain_batch")]
    for place in places:
        if place and os.path.isfile(place) and os.access(place, os.X_OK):
            return os.path.abspath(place)
    raise Problem("there is no curtain_batch %s" % (given or "beside this script, in build-engine or on the PATH; say where with --curtain-batch"))


def version_of(batch):
    """What curtain_batch --version says."""
    answer = subprocess.run([batch, "--version"], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if answer.returncode != 0:
        raise Problem("%s --version: %s" % (batch, answer.stderr.strip() or "exit code %d" % answer.returncode))
    return answer.stdout.strip()


def need_parallel():
    """GNU parallel, not the program of this name in moreutils."""
    found = shutil.which("parallel")
    version = subprocess.run([found, "--version"], text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False).stdout if found else ""
    if not version.startswith("GNU parallel"):
        raise Problem("GNU parallel is needed (Debian's package parallel)")


class Machines:
    """Makes the runs of a folder, `jobs` at a time on each machine."""

    def __init__(self, batch, jobs, ssh):
        self.batch = batch
        self.jobs = jobs
        self.ssh = "%s %s" % (ssh, SSH)
        self.hosts = None  # none: this machine alone

    def environment(self, **more):
        """parallel's. It takes ssh's name from there: of 2016, Debian 11's, it forgets its option --ssh with --nonall."""
        return dict(os.environ, PARALLEL_SSH=self.ssh, **more)

    def ask(self, path, version):
        """Keeps the hosts of a file that answer and have the same curtain_batch; returns what is wrong with the others."""
        try:
            with open(path, encoding="utf-8") as file:
                lines = [line.split("#")[0].strip() for line in file]
        except OSError as error:
            raise Problem("%s: cannot be read: %s" % (path, error.strerror)) from error
        lines = list(dict.fromkeys(line for line in lines if line))
        if not lines:
            raise Problem("%s: names no host" % path)
        if any(line.split("/")[-1] != ":" for line in lines) and not shutil.which("rsync"):
            raise Problem("rsync is needed for other machines (Debian's package rsync), on them, too")
        names = {line: re.sub(r"^\d+/", "", line) for line in lines}
        question = FIND % shlex.quote(self.batch) + '"$batch" --version'
        answer = subprocess.run(["parallel", "--nonall", "--tag", "--timeout", "30", "-j0", "-S", ",".join(names.values()),
                                 "sh -c %s" % shlex.quote(question)], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, check=False, env=self.environment())
        troubles = []
        self.hosts = []
        for line, name in names.items():
            said = [text[len(name) + 1:].strip() for text in answer.stdout.splitlines() if text.startswith(name + "\t")]
            if said == [version]:
                self.hosts.append(line)
                continue
            why = [text[len(name) + 1:].strip() for text in answer.stderr.splitlines() if text.startswith(name + "\t")]
            why = (re.sub(re.escape(name) + "$", "", why[0]).strip() if why else "") or "no answer"
            if said:
                troubles.append("host %s has %s, this machine %s" % (name, said[0], version))
            elif "not found" in why:
                troubles.append("host %s has no curtain_batch, neither %s nor on its PATH" % (name, self.batch))
            else:
                troubles.append("host %s does not answer: %s" % (name, why))
        return troubles

    def make(self, folder, design, scenes, with_trajectories, bar):
        """Makes what the folder's job log does not have, until no run is left or nothing goes on; returns what parallel and the runs
        had to say, which with a bar has gone to the terminal. Interrupted: raises KeyboardInterrupt when all runs have ended."""
        runs = os.path.abspath(folder.of("runs"))
        rate = " --sample-rate %r" % design.samples_per_second if design.samples_per_second > 0 else ""
        sample = '--out "$1.csv"' + rate if with_trajectories else ""
        empty = ' && : >"$1.csv"' if with_trajectories else ""
        job = JOB % (shlex.quote(self.batch), shlex.quote(runs), repr(design.duration), sample, empty)
        command = ["setpriv", "--pdeathsig", "TERM",  # what a killed sweep leaves starts no more runs
                   "parallel", "--ungroup", "--jobs", str(self.jobs), "--arg-file", os.path.abspath(folder.of("runs.txt")),
                   "--joblog", os.path.abspath(folder.of("joblog")), "--resume-failed", "--halt", "soon,fail=%d" % FAILED]
        if bar:
            command.append("--bar")
        if self.hosts:
            command += ["--sshloginfile", os.path.abspath(folder.of("hosts")), "--retries", str(TRIES),
                        "--env", "SWEEP_JOB"]  # here it is there already, and asking for it would double what parallel takes
        if self.hosts and self.hosts != [":"]:
            command += ["--workdir", "...", "--cleanup", "--transferfile", "{}.yaml", "--return", "{}.result"]
            for mesh in scenes.meshes:
                command += ["--transferfile", mesh]
            if with_trajectories:
                command += ["--return", "{}.csv"]
        command += ['sh -c "$SWEEP_JOB" sh', "{}"]
        process = subprocess.Popen(command, cwd=runs, stdin=subprocess.DEVNULL, stderr=None if bar else subprocess.PIPE, text=True,
                                   pass_fds=[folder.lock], env=self.environment(PARALLEL_SHELL="/bin/sh", SWEEP_JOB=job))
        try:
            return process.communicate()[1] or ""
        except KeyboardInterrupt:
            for _ in range(2):  # the first: no more runs; the second: end those that are at work
                process.send_signal(signal.SIGTERM)
                try:
                    process.wait(1.0)
                except subprocess.TimeoutExpired:
                    continue
            process.communicate()
            raise


def missing_runs(results, scenes, said):
    """What is not made, as text, and why; nothing: all is."""
    made = {result.name for result in results}
    missing = [name for name in scenes.names if name not in made]
    if not missing:
        return ""
    reasons = re.findall(r"^run .*", said, re.M) or [line for line in said.splitlines() if line.strip()]
    return "%d of %d runs are not made%s" % (len(missing), len(scenes.names), ": " + reasons[0] if reasons else ", the first is " + missing[0])
