"""The shares of an ensemble as tasks of Dask or of Ray: python tasks.py dask|ray SHARES FOLDER.

ENSEMBLE is the program, and the folder one that all workers see. A task whose program is killed is tried again by the
engine, and makes what is missing of its share.
"""

import os
import subprocess
import sys
import tempfile

engine, shares, out = sys.argv[1], int(sys.argv[2]), sys.argv[3]
program = os.environ["ENSEMBLE"]


def make(share):
    command = [program, "--quick", "--threads", "1", "--out", out, "--share", f"{share}/{shares}"]
    return subprocess.run(command, check=True, stdout=subprocess.DEVNULL).returncode


if __name__ == "__main__":
    # What the engines write for themselves.
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as own:
        if engine == "dask":
            from dask.distributed import Client

            with Client(n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=own) as client:
                codes = client.gather(client.map(make, range(shares), retries=3))
        else:
            import ray

            ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, _temp_dir=own)
            # Without the second only a worker that dies is replaced, and an exception of the task is its end.
            task = ray.remote(max_retries=3, retry_exceptions=True)(make)
            codes = ray.get([task.remote(share) for share in range(shares)])
            ray.shutdown()
    print(f"{engine}: {len(codes)} shares")
