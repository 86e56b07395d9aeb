#!/bin/bash
# The second job, an array with a task for each part: draws the frames of a part. Finished frames of the same scene, version
# and settings are kept.
#   bash frames.sh PART               by hand, with the number of the part, from 1
#   sbatch --array=PART frames.sh     on the cluster
@SBATCH@
set -u
source @SETTINGS@ || exit
part=${1:-${SLURM_ARRAY_TASK_ID-}}
if ! [[ $part =~ ^[1-9][0-9]*$ ]] || ((part > ${#parts[@]})); then
    echo "usage: frames.sh PART, a number from 1 to ${#parts[@]}" >&2
    exit 2
fi
cores=()   # those that Slurm has given to the task
[[ -n ${SLURM_CPUS_PER_TASK-} ]] && cores=(--workers "$SLURM_CPUS_PER_TASK" --threads "$SLURM_CPUS_PER_TASK")
try "part $part (frames ${parts[part - 1]})" "$program" render "${scenes[@]}" "${render_options[@]}" --quiet "${cores[@]}" \
    --frames "$folder/frames" --frames-range "${parts[part - 1]}" --from-checkpoints "$folder/checkpoints" --resume
