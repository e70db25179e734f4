"""What the wheel carries beside the packages, as the report and the check read it."""

from pathlib import Path
from shutil import copytree

from setuptools import setup
from setuptools.command.build_py import build_py

CARRIED = ("notebooks", "results/reference")


class BuildWithFolders(build_py):
    """Copies the folders to where ``experiments.carried`` looks for them."""

    def run(self) -> None:
        """Build the packages, then copy; an editable install reads the checkout."""
        super().run()
        if not self.editable_mode:
            for folder in CARRIED:
                place = Path(self.build_lib, "experiments", "carried", folder)
                copytree(Path(__file__).parent / folder, place, dirs_exist_ok=True)


setup(cmdclass={"build_py": BuildWithFolders})
