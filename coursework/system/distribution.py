"""What is installed under the import name ``coursework``: the distribution's own name, and its version.

On public indexes ``coursework`` is the name of other people's package; ``pip`` is told this one.
"""

DISTRIBUTION = "mechanism-coursework"
VERSION = "0.1.0"


def pip_install(requirement: str = "") -> str:
    """The command that installs a requirement, the package in this very version unless told."""
    told = requirement or f"{DISTRIBUTION}=={VERSION}"
    return f'pip install "{told}"' if set(told) & set(" ;<>&|[]*~!") else f"pip install {told}"
