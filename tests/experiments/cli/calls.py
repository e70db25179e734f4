"""Commands as a user types them."""

from typer.testing import CliRunner

from experiments.cli import app
from experiments.cli.console import console, errors


def hem(*arguments: str, width: int = 400, said: str | None = None) -> tuple[int, str]:
    """Run a command where lines are so wide -> its exit code, and all that it printed."""
    console.width = errors.width = width
    result = CliRunner().invoke(app, arguments, input=said)
    return result.exit_code, result.stdout + result.stderr


def words(*arguments: str) -> tuple[int, str]:
    """The same as one line, without the frame around a mistake."""
    code, output = hem(*arguments)
    return code, " ".join(output.replace("│", "").split())


def output_of(*arguments: str) -> str:
    """What a command says that does what it was asked, as one line."""
    code, output = words(*arguments)
    assert code == 0, output
    return output


def mistake(*arguments: str, code: int = 1) -> str:
    """What a command says that ends with this exit code, as one line that it begins itself."""
    ended, output = words(*arguments)
    assert ended == code, output
    assert output.startswith("hem:")
    return output
