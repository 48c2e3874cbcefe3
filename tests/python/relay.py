"""A relay with its simulator, on ports of its own, for tests."""

import os
import pathlib
import subprocess
import tempfile
import time


class Relay:
    """kenaf-relayd --embedded for the time of a with block; `address` is where it listens."""

    def __enter__(self) -> "Relay":
        self.folder = tempfile.TemporaryDirectory()
        port_file = pathlib.Path(self.folder.name) / "port"
        with open(pathlib.Path(self.folder.name) / "log", "wb") as log:
            self.process = subprocess.Popen(
                [os.environ["KENAF_BIN_DIR"] + "/kenaf-relayd", "--embedded", "--listen", "127.0.0.1:0"]
                + ["--port-file", str(port_file), "--speed", "0", "--view", "off", "--cameras", "off", "--camera-port", "off"],
                stdout=log,
                stderr=log,
            )
        while not port_file.exists() or not port_file.read_text().strip():
            if self.process.poll() is not None:
                raise RuntimeError((pathlib.Path(self.folder.name) / "log").read_text())
            time.sleep(0.02)
        self.address = "127.0.0.1:" + port_file.read_text().strip()
        return self

    def __exit__(self, *raised: object) -> None:
        self.process.terminate()
        self.process.wait()
        self.folder.cleanup()
