"""Run the command line as ``carom`` or as ``python -m carom``."""

import gc
import os
import sys
import threading


def run() -> int:
    """Load and run the command line; return its exit code.

    A Ctrl-C while it is being loaded ends it as quietly as one while it runs.
    """
    # No matrix here is so large that several threads would help, and each costs time to start.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        from carom.cli import main

        code = main()
    except KeyboardInterrupt:
        print("carom: interrupted", file=sys.stderr)  # noqa: T201
        code = 130
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 1
    for thread in set(threading.enumerate()) - {threading.current_thread()}:
        thread.join(0.25)  # those that manage other processes end by themselves
    if threading.active_count() > 1:
        # A thread that is still in a kernel would come back to an interpreter that is gone, which may wait for it for ever.
        gc.collect()  # what is shared with other processes, such as semaphores, is let go first
        os._exit(code)
    # After a Ctrl-C during an import that runs generated code, Python exits by that signal, whatever code is returned.
    # Running any other code resets this.
    exec("")
    # The interpreter looks for garbage once more before it ends, among a few hundred thousand objects that end with it.
    gc.freeze()
    return code


if __name__ == "__main__":
    sys.exit(run())
