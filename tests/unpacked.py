"""What a page of an explorer holds packed, as text: for tests that look for something in it."""

import base64
import gzip
import re


def unpacked(page: str) -> str:
    """The page with the state of its scene as JSON, where it stands compressed."""
    return re.sub(
        r'(?<=gunzip\(unpack\(")[^"]+',
        lambda found: gzip.decompress(base64.b64decode(found[0])).decode(),
        page,
    )
