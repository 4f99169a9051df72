"""A client of an application without a server: it runs the application in its own thread, on one event loop.

starlette's client begins a thread with an event loop for each request, which takes more time than most pages
do.
"""

import asyncio
import atexit
import threading
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from urllib.parse import unquote

from starlette import testclient


@cache
def _loop():
    """The event loop of the main thread's requests."""
    loop = asyncio.new_event_loop()
    atexit.register(loop.close)
    return loop


class Transport(testclient.httpx.BaseTransport):
    """Hands a request to an application and waits for the end of its response; what the application raises is
    raised."""

    def __init__(self, app, client):
        self.app, self.client = app, client

    def handle_request(self, request):
        if asyncio._get_running_loop() is not None:  # that of a real browser, which a test drives from here
            with ThreadPoolExecutor(1) as pool:
                return pool.submit(self.handle_request, request).result()
        is_main = threading.current_thread() is threading.main_thread()
        return (_loop().run_until_complete if is_main else asyncio.run)(self._response(request))

    async def _response(self, request):
        url = request.url
        port = url.port or {"http": 80, "https": 443}[url.scheme]
        scope = {
            "type": "http",
            "http_version": "1.1",
            "method": request.method,
            "path": unquote(url.path),
            "raw_path": url.raw_path.partition(b"?")[0],
            "root_path": "",
            "scheme": url.scheme,
            "query_string": url.query,
            "headers": [
                (name.lower().encode(), text.encode()) for name, text in request.headers.multi_items()
            ],
            "client": self.client,
            "server": [url.raw_host.decode("ascii"), port],
            "extensions": {},
            "state": {},
        }
        body, sent, ended = [request.read()], [], asyncio.Event()

        async def receive():
            if body:
                return {"type": "http.request", "body": body.pop()}
            await ended.wait()
            return {"type": "http.disconnect"}

        async def send(message):
            assert not ended.is_set(), "a message after the end of the response"
            sent.append(message)
            if message["type"] == "http.response.body" and not message.get("more_body", False):
                ended.set()

        await self.app(scope, receive, send)
        start, *parts = sent
        assert start["type"] == "http.response.start"
        content = b"" if request.method == "HEAD" else b"".join(part.get("body", b"") for part in parts)
        headers = [(name.decode(), text.decode()) for name, text in start["headers"]]
        return testclient.httpx.Response(start["status"], headers=headers, content=content, request=request)


class Client(testclient.TestClient):
    """Client that follows no address by itself."""

    def __init__(self, app, base_url, headers=None, client=("testclient", 50000)):
        super().__init__(app, base_url=base_url, headers=headers, follow_redirects=False)
        self._transport = Transport(app, client)
