// Follows the changes of a job: by events if the server sends them, otherwise by polling.
import {events, get} from './api.js';

export function ended(job) {
  return job.state === 'succeeded' || job.state === 'failed' || job.state === 'cancelled';
}

export function pause(milliseconds, signal) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, milliseconds);
    signal?.addEventListener('abort', () => { clearTimeout(timer); reject(signal.reason); }, {once: true});
  });
}

// Calls changed(job) until the job has ended or the signal aborts.
export async function watchJob(id, changed, signal) {
  const path = `/v1/jobs/${encodeURIComponent(id)}`;
  let job = await get(path, signal);
  changed(job);
  for (let lastId = ''; !ended(job);) {
    try {
      for await (const message of events(`${path}/events`, lastId, signal)) {
        lastId = message.id || lastId;
        job = JSON.parse(message.data);
        changed(job);
        if (ended(job)) return;
      }
    } catch (error) {
      if (signal.aborted || error.status === 404) throw error;
    }
    await pause(1500, signal);
    job = await get(path, signal);
    changed(job);
  }
}
