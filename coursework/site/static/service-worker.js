// Pages that a person has seen open without a network as well: those that the server marks with ``offline-until``, seconds of the epoch.
// One person's at a time: they go at signing out, when a page says that somebody else or nobody is signed in, and when their time is over.
"use strict";
const SHARED = "shared", PAGES = "pages ", FIGURES = "figures", FALLBACK = "/offline", MOST = 60;
const LEAVING = ["/sign-out", "/sign-in", "/who"];
let generation = 0;  // pages that were asked for before a clearing are not stored after it

async function clear(except) {
  generation += 1;
  const others = (await caches.keys()).filter((name) => name !== SHARED && name !== except);
  await Promise.all(others.map((name) => caches.delete(name)));
}
const isOver = (reply) => !(1000 * Number(reply.headers.get("offline-until")) > Date.now());
async function purge() {
  for (const name of (await caches.keys()).filter((one) => one.startsWith(PAGES))) {
    const cache = await caches.open(name), keys = await cache.keys();
    for (const [index, key] of keys.entries()) {
      const reply = await cache.match(key);
      if (!reply || isOver(reply) || index < keys.length - MOST) await cache.delete(key);
    }
  }
}

async function store(url, reply, began) {
  if (reply.type === "opaqueredirect" || reply.status >= 500) return;
  const person = reply.headers.get("x-person");
  if (!person) { await clear(""); return; }
  if ((await caches.keys()).some((name) => name.startsWith(PAGES) && name !== PAGES + person)) {
    await clear(PAGES + person);
    began = generation;  // this very page says whose it is
  }
  if (!reply.ok || reply.redirected || isOver(reply) || began !== generation) return;
  const cache = await caches.open(PAGES + person);
  await cache.delete(url);
  await cache.put(url, reply);
  if (began !== generation) await caches.delete(PAGES + person);
}
const bare = (address) => address.split("#")[0];

async function page(event) {
  const began = generation;
  let reply;
  try { reply = await fetch(event.request); } catch (fault) { return stored(event.request.url); }
  event.waitUntil(store(bare(event.request.url), reply.clone(), began).then(purge).catch(() => undefined));
  return reply;
}
async function stored(address) {
  await purge();
  for (const name of (await caches.keys()).filter((one) => one.startsWith(PAGES))) {
    const found = await (await caches.open(name)).match(bare(address), { ignoreVary: true });
    if (found) return found;
  }
  return (await caches.match(FALLBACK, { ignoreVary: true })) || Response.error();
}
// A form without a network leaves its page where it is, and the page tells so.
async function posted(event, path) {
  if (LEAVING.includes(path)) await clear("");
  try { return await fetch(event.request); } catch (fault) {
    for (const client of await self.clients.matchAll({ type: "window" })) client.postMessage({ offline: true });
    return new Response(null, { status: 204 });
  }
}
// A figure, or the steps, of a lesson: its address changes with it.
const isFigure = (url) => /^\/lessons\/[^/]+\/(figures|steps)\//.test(new URL(url).pathname);
async function shared(request) {
  const [name, most] = isFigure(request.url) ? [FIGURES, 6 * MOST] : [SHARED, MOST];
  const cache = await caches.open(name), found = await cache.match(request, { ignoreVary: true });
  if (found) return found;
  const reply = await fetch(request);
  if (reply.ok) {
    await cache.put(request, reply.clone());
    const keys = (await cache.keys()).filter((key) => !key.url.endsWith(FALLBACK));
    for (const key of keys.slice(0, Math.max(0, keys.length - most))) await cache.delete(key);
  }
  return reply;
}

self.addEventListener("install", (event) => {
  self.skipWaiting();
  const fallback = new Request(FALLBACK, { credentials: "omit", cache: "reload" });
  event.waitUntil(caches.open(SHARED).then((cache) => cache.add(fallback)));
});
self.addEventListener("activate", (event) => event.waitUntil(Promise.all([self.clients.claim(), purge()])));
self.addEventListener("fetch", (event) => {
  const url = new URL(event.request.url), method = event.request.method;
  if (url.origin !== self.location.origin || url.pathname.startsWith("/lti")) return;
  if (method === "GET" && (url.pathname.startsWith("/static/") && url.search || isFigure(url))) event.respondWith(shared(event.request));
  else if (event.request.mode !== "navigate") return;
  else if (method === "GET") event.respondWith(page(event));
  else event.respondWith(posted(event, url.pathname));
});
// The page that brought this worker was loaded without it; a lesson has figures that nobody has looked at yet.
self.addEventListener("message", (event) => {
  const began = generation, { seen, files } = event.data || {};
  const own = (address) => new URL(address, self.location.origin).origin === self.location.origin;
  if (event.origin && event.origin !== self.location.origin) return;
  const page = seen && own(seen) ? [fetch(seen, { credentials: "same-origin" }).then((reply) => store(bare(seen), reply, began))] : [];
  event.waitUntil(Promise.all([...page, ...(files || []).filter(own).map((file) => shared(new Request(file)))]).catch(() => undefined));
});
