"""`farm slurm` on a node that loses its power while it draws: Slurm runs the part again on another node, and the clip has the
bytes of a local run. Takes most of a minute, because Slurm waits before it takes a node for lost. Skipped without Slurm."""

import pathlib
import re
import shutil
import sys
import tempfile
import unittest

import slurm_cluster
from farm_case import SCENE, TUMBLE, local_clips, run_tumble

if not slurm_cluster.available():
    print("skipped: no Slurm (scripts/install-dependencies --test)")
    sys.exit(77)

# On its first node, part 2 draws its first frame and then waits for the end of the node.
SLOW = """\
#!/bin/bash
if [[ " $* " == *" --frames-range 3-5 "* ]] && mkdir '{mark}' 2>/dev/null; then
    '{tumble}' "${{@/#3-5/3}}" && [[ -e '{folder}/frames/frame_000003.png' ]] && echo "$SLURMD_NODENAME" > '{mark}/node'
    exec sleep infinity
fi
exec '{tumble}' "$@"
"""


class NodeLoss(unittest.TestCase):
    def test_the_part_is_drawn_on_the_other_node(self):
        root = pathlib.Path(tempfile.mkdtemp(prefix="tumble-farm-"))
        self.addCleanup(shutil.rmtree, root)
        (root / "scene.toml").write_text(SCENE)
        (root / "slurm").mkdir()
        mark, folder, program = root / "mark", root / "clip.mp4.farm", root / "slow-tumble"
        program.write_text(SLOW.format(mark=mark, tumble=TUMBLE, folder=folder))
        program.chmod(0o755)
        cluster = self.enterContext(slurm_cluster.Cluster(root / "slurm"))
        submitted = run_tumble(root, "farm", "slurm", "scene.toml", "--parts", 4, "-o", "clip.mp4", "--program", program,
                               env=cluster.environment)
        self.assertEqual(submitted.returncode, 0, submitted.stderr)
        frames = int(re.search(r"^job (\d+): frames", submitted.stdout, re.M)[1])
        cluster.until(lambda: (mark / "node").exists() and (mark / "node").read_text().endswith("\n"), "part 2 draws")
        node = (mark / "node").read_text().strip()
        cluster.kill_node(node)
        local = local_clips(root, "scene.toml", encode=())
        cluster.wait_for_end_of_jobs(guard=180)
        logs = "".join(f"--- {log.name}\n{log.read_text()}" for log in sorted((folder / "log").iterdir()))
        self.assertTrue((root / "clip.mp4").exists(), logs + cluster.queue() + cluster.logs() + (root / "slurm/log/jobcomp.txt").read_text())
        self.assertEqual((root / "clip.mp4").read_bytes(), local.rendered)
        self.assertEqual((root / "clip.mp4").read_bytes(), local.encoded)
        records = (root / "slurm/log/jobcomp.txt").read_text()
        lost = [line for line in records.splitlines() if "NODE_FAIL" in line and "ArrayTaskId=2 " in line]
        self.assertEqual(len(lost), 1, records)
        self.assertIn(f"NodeList={node} ", lost[0])
        self.assertNotEqual(cluster.job(f"{frames}_2")["BatchHost"], node)


if __name__ == "__main__":
    unittest.main(verbosity=2)
