#!/usr/bin/env python3
"""Fetches a page and every file that it names, and those that these name, as a browser would.

    fetch_page.py URL [FRAGMENT]...

Prints each file with its size. Fails if one is not answered with 200 and its own type, or is empty, or if no file's
path has one of the FRAGMENTs.
"""
import re
import sys
import urllib.error
import urllib.request
from urllib.parse import urljoin, urlsplit

# How each kind of file names others.
NAMES = {
    "text/html": [r'(?:src|href)="([^"#?]+)"'],
    "text/css": [r'url\(\s*["\']?([^"\')]+)["\']?\s*\)', r'@import\s+["\']([^"\']+)'],
    "text/javascript": [r'(?:^|[;}\s])(?:import|export)\b[^;"\']*?\bfrom\s*["\']([^"\']+)["\']',
                        r'(?:^|[;}\s])import\s*\(?\s*["\']([^"\']+)["\']'],
    "image/svg+xml": [],
}
TYPES = {"html": "text/html", "css": "text/css", "js": "text/javascript", "svg": "image/svg+xml"}


def fetch(url):
    try:
        with urllib.request.urlopen(url, timeout=60) as answer:
            return answer.headers.get_content_type(), answer.read()
    except urllib.error.HTTPError as error:
        sys.exit(f"fetch_page: {url}: {error.code} {error.reason}")


def main():
    first, fragments = sys.argv[1].split("#")[0], sys.argv[2:]
    waiting, seen = [first], {first}
    while waiting:
        url = waiting.pop()
        kind, data = fetch(url)
        expected = TYPES.get(urlsplit(url).path.rpartition(".")[2], "text/html")
        if kind != expected or not data:
            sys.exit(f"fetch_page: {url}: {len(data)} bytes of {kind}, not {expected}")
        print(f"{len(data):8} {urlsplit(url).path}")
        for pattern in NAMES[kind]:
            for name in re.findall(pattern, data.decode("utf-8"), re.M):
                found = urljoin(url, name)
                if name.startswith("data:") or found in seen:
                    continue
                if urlsplit(found).netloc != urlsplit(first).netloc:
                    sys.exit(f"fetch_page: {url} names {found}, which is elsewhere")
                seen.add(found)
                waiting.append(found)
    for fragment in fragments:
        if not any(fragment in url for url in seen):
            sys.exit(f"fetch_page: no file of {first} is called {fragment}")


main()
