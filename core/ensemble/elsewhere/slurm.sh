#!/bin/bash
#SBATCH --array=0-3
#SBATCH --cpus-per-task=2
# sbatch --export=ENSEMBLE=…,OUT=… slurm.sh; what has failed is submitted again, and makes what is missing.
set -eu
exec "$ENSEMBLE" --quick --threads "${SLURM_CPUS_PER_TASK:-2}" --out "$OUT" \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
