#!/bin/bash
# Submits the jobs to Slurm.
#   bash submit.sh                    everything: the simulation, all parts, and the job that makes the clip
#   bash submit.sh PARTS              these parts again, as in 3,7-9, and the job that makes the clip
set -u
source @SETTINGS@ || exit
wanted=${1-} round=${2:-0}
submitted=() after=()
stop() {
    ((${#submitted[@]} == 0)) || scancel "${submitted[@]}"
    exit 1
}
if [[ -z $wanted ]]; then
    job=$(sbatch --parsable "$folder/simulate.sh") || stop
    submitted+=("${job%%;*}")
    echo "job ${job%%;*}: simulation"
    # Without the simulation the parts would wait forever.
    after=("--dependency=afterok:${job%%;*}" --kill-on-invalid-dep=yes)
    wanted=1-${#parts[@]}
fi
job=$(sbatch --parsable "${after[@]}" "--array=$wanted" "$folder/frames.sh") || stop
submitted+=("${job%%;*}")
echo "job ${job%%;*}: frames, parts $wanted"
# Not afterok: the last job names the parts that failed.
job=$(sbatch --parsable "--dependency=afterany:${job%%;*}" "$folder/stitch.sh" "$round") || stop
echo "job ${job%%;*}: clip"
