#!/bin/bash
#SBATCH --array=0-3
#SBATCH --cpus-per-task=2
# sbatch --export=ENSEMBLE=…,OUT=… slurm.sh; what has failed is submitted again, as by --array=3, and makes what is missing.
set -eu
# One for each number of the whole array. Slurm's own count is that of the tasks that are submitted together.
SHARES=4
exec "$ENSEMBLE" --quick --threads "${SLURM_CPUS_PER_TASK:-2}" --out "$OUT" --share "$SLURM_ARRAY_TASK_ID/$SHARES"
