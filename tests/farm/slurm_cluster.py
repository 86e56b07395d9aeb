"""A Slurm cluster of two nodes on the loopback interface of this machine, in a folder of its own.

It needs no root, no munge and no configuration of the system: Debian's slurmctld, slurmd and slurm-client. All daemons
listen on 127.0.0.1 only; that is checked, because this configuration runs commands for everyone that can connect.
"""

import getpass
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import time

PROGRAMS = ("slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "sinfo", "scancel")
NODES = ("n1", "n2")
GUARD = 60   # s, against a hang: far more than a start or a stop takes on a busy machine

# CPUs: more than the machine has, because the scheduler starts tasks in ticks of a second, so that free slots decide the
# rate (config_overrides allows it). cred_expire: otherwise a task that is run again waits two minutes.
CONFIGURATION = """\
ClusterName=t{port}
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
AuthInfo=cred_expire=5
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny,NoAddrCache
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/run/slurmctld.pid
SlurmdPidFile={folder}/run/slurmd-%n.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc={folder}/log/jobcomp.txt
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=sched_interval=1,batch_sched_delay=0,bf_interval=1
ReturnToService=2
JobRequeue=1
SlurmctldTimeout=10
SlurmdTimeout=5
KillWait=2
MinJobAge=600
BatchStartTimeout=5
MessageTimeout=5
UnkillableStepTimeout=10
PropagateResourceLimits=NONE
SlurmdParameters=config_overrides
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={port1} CPUs=4 RealMemory=1000
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={port2} CPUs=4 RealMemory=1000
PartitionName=p Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def available():
    """Whether the programs of Slurm are there."""
    path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"   # the daemons are there for root only
    return all(shutil.which(name, path=path) for name in PROGRAMS)


def free_ports():
    """The first of three free ports in a row."""
    for _ in range(200):
        first = random.randrange(20000, 32000)   # below the ports that the system gives to clients
        held = []
        try:
            for port in range(first, first + 3):
                held.append(socket.socket())
                held[-1].bind(("127.0.0.1", port))
            return first
        except OSError:
            continue
        finally:
            for one in held:
                one.close()
    raise RuntimeError("no free ports")


class Cluster:
    """`with Cluster(folder) as cluster`: running, with both nodes idle. The folder must exist and be empty."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf"),
                            "PATH": os.environ.get("PATH", "") + ":/usr/sbin:/sbin"}
        for name in ("SBATCH_", "SLURM_", "SQUEUE_"):   # this test may itself be a job of another cluster
            for key in [key for key in self.environment if key.startswith(name) and key != "SLURM_CONF"]:
                del self.environment[key]

    def __enter__(self):
        for name in ("state", "run", "log", "spool/n1", "spool/n2"):
            (self.folder / name).mkdir(parents=True)
        self.ports = [free_ports()]
        self.ports += [self.ports[0] + 1, self.ports[0] + 2]
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            folder=self.folder, user=getpass.getuser(), host=socket.gethostname().split(".")[0],
            port=self.ports[0], port1=self.ports[1], port2=self.ports[2]))
        try:
            self.run("slurmctld", "-c")
            for node in NODES:
                self.start_node(node)
            self.until(lambda: len(self.idle_nodes()) == 2, "both nodes are idle")
            self.check_listens_on_loopback_only()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *error):
        self.stop()

    # Programs.

    def run(self, *words, **options):
        """The standard output of one of Slurm's programs; an error is an exception with its message."""
        done = subprocess.run(words, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, timeout=GUARD, **options)
        if done.returncode != 0:
            raise RuntimeError(f"{words}: exit code {done.returncode}\n{done.stdout}{done.stderr}{self.logs()}")
        return done.stdout

    def until(self, condition, what, guard=GUARD):
        deadline = time.monotonic() + guard
        while not condition():
            if time.monotonic() > deadline:
                raise TimeoutError(f"not within {guard} s: {what}\n{self.queue()}{self.logs()}")
            time.sleep(0.1)

    def logs(self):
        return "".join(f"--- {file.name}\n{file.read_text(errors='replace')[-3000:]}\n"
                       for file in sorted((self.folder / "log").glob("slurm*.log")))

    # Nodes.

    def start_node(self, node):
        self.run("slurmd", "-N", node)

    def idle_nodes(self):
        return self.run("sinfo", "-h", "-N", "-t", "idle", "-o", "%N").split()

    def state_of(self, node):
        return self.run("sinfo", "-h", "-N", "-n", node, "-o", "%T").strip()

    def drain(self, node):
        self.run("scontrol", "update", f"NodeName={node}", "State=DRAIN", "Reason=test")

    def resume(self, node):
        self.run("scontrol", "update", f"NodeName={node}", "State=RESUME")

    def kill_node(self, node):
        """As if its machine had lost its power: the daemon, its steps and their tasks end at once."""
        tasks = self.processes_of(node)
        steps = {parent_of(pid) for pid in tasks}   # slurmstepd, which would report the end of the tasks
        steps = [pid for pid in steps if name_of(pid) == "slurmstepd"]
        for pid in [self.pid_of(f"slurmd-{node}"), *steps, *tasks]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        (self.folder / f"run/slurmd-{node}.pid").unlink(missing_ok=True)

    def processes_of(self, node):
        """The processes of jobs on a node, by the variable that Slurm gives to them."""
        return processes_with(self.environment["SLURM_CONF"], "SLURMD_NODENAME=" + node)

    # Jobs.

    def queue(self):
        """Of all jobs, also finished ones: dictionaries as scontrol prints them."""
        try:
            return self.run("squeue", "-a", "-h", "-r", "-t", "all", "-o", "%i|%j|%T|%r|%N")
        except RuntimeError as error:
            return str(error)

    def jobs(self):
        """{"12_3": "COMPLETED"} of all jobs and array tasks, also finished ones."""
        return {row.split("|")[0]: row.split("|")[2] for row in self.queue().splitlines()}

    def job(self, number):
        """The fields of a job as scontrol prints them."""
        text = self.run("scontrol", "show", "job", "-o", str(number)).splitlines()[0]
        return dict(word.partition("=")[::2] for word in text.split(" "))

    def wait_for_end_of_jobs(self, guard=120):
        active = ("PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "REQUEUED", "SUSPENDED")
        self.until(lambda: self.jobs() and not any(state in active for state in self.jobs().values()),
                   "all jobs ended", guard)

    # The end.

    def pid_of(self, name):
        return int((self.folder / f"run/{name}.pid").read_text())

    def stop(self):
        """Ends all jobs first, because a stopped daemon leaves its jobs running."""
        try:
            self.run("scancel", "--me")
            self.until(lambda: not self.run("squeue", "-h"), "no job is left")
        except Exception:   # the controller is not there: the processes below are
            pass
        for file in (self.folder / "run").glob("*.pid"):
            try:
                os.kill(int(file.read_text()), signal.SIGTERM)
            except (ProcessLookupError, ValueError, FileNotFoundError):
                pass
        deadline = time.monotonic() + 20
        while list((self.folder / "run").glob("*.pid")) and time.monotonic() < deadline:
            time.sleep(0.05)
        for pid in processes_with(self.environment["SLURM_CONF"]):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    # Security.

    def check_listens_on_loopback_only(self):
        listening = listening_addresses()
        for port in self.ports:
            addresses = listening.get(port, set())
            if addresses != {"127.0.0.1"}:
                raise RuntimeError(f"port {port} listens on {addresses or 'nothing'} instead of 127.0.0.1")


def processes_with(configuration, variable=None):
    """The processes (but this one) whose environment has this slurm.conf, and the variable."""
    found = []
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "environ").read_bytes().split(b"\0")
        except OSError:
            continue
        if ("SLURM_CONF=" + configuration).encode() in words and int(folder.name) != os.getpid() and \
                (variable is None or variable.encode() in words):
            found.append(int(folder.name))
    return found


def parent_of(pid):
    """0 if it has ended."""
    try:
        return int(pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


def name_of(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/comm").read_text().strip()
    except OSError:
        return ""


def listening_addresses():
    """{port: {address}} of all TCP sockets that listen, IPv6 ones too."""
    found = {}
    for name in ("/proc/net/tcp", "/proc/net/tcp6"):
        try:
            rows = pathlib.Path(name).read_text().splitlines()[1:]
        except OSError:
            continue
        for row in rows:
            local, state = row.split()[1], row.split()[3]
            if state != "0A":
                continue
            address, port = local.split(":")
            text = (".".join(str(b) for b in reversed(bytes.fromhex(address))) if len(address) == 8 else "IPv6 " + address)
            found.setdefault(int(port, 16), set()).add(text)
    return found
