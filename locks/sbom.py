"""Write the inventory of what a lock file installs, with the third-party files of the package itself, as
CycloneDX 1.6 (JSON).

Run by ``make sbom``: python locks/sbom.py locks/site.txt build/site.cdx.json
"""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ASSETS = tomllib.loads((ROOT / "coursework/third_party.toml").read_text("utf-8"))["asset"]


def component(asset: dict[str, str]) -> dict[str, object]:
    """Return a third-party file as a component of CycloneDX."""
    return {
        "type": "library",
        "bom-ref": f"{asset['name']}=={asset['version']}",
        "name": asset["name"],
        "version": asset["version"],
        "description": f"{asset['file']}: {asset['source']}",
        "hashes": [{"alg": "SHA-256", "content": asset["sha256"]}],
        "licenses": [{"license": {"id": asset["licence"]}}],
    }


def main(lock: str, out: str) -> None:
    """Write the inventory of one lock file."""
    made = subprocess.run(
        [
            sys.executable,
            "-m",
            "cyclonedx_py",
            "requirements",
            lock,
            "--pyproject",
            str(ROOT / "pyproject.toml"),
            "--sv",
            "1.6",
            "--output-reproducible",
        ],
        stdout=subprocess.PIPE,
        check=True,
        text=True,
    )
    inventory = json.loads(made.stdout)
    inventory["components"] += [component(asset) for asset in ASSETS]
    path = Path(out)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(inventory, indent=2) + "\n", "utf-8")
    print(f"{len(inventory['components'])} components in {out}")


if __name__ == "__main__":
    main(*sys.argv[1:])
