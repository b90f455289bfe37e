// One study: what it is, what is done to it, and the job that works on it.
import { computed, signal } from "@preact/signals";
import { get, over, post, type Refused } from "../../api/client";
import type { Job, Posts, Study } from "../../api/schema";
import { jobs, listStudies, mayChange } from "../../state";

export class StudyStore {
  readonly study = signal<Study | null>(null);
  readonly problem = signal("");
  readonly preview = signal(""); // a term
  readonly job = signal<string>("");
  readonly working = computed(() => {
    const job = jobs.value.get(this.job.value);
    return job && !over(job) ? job : null;
  });
  readonly busy = signal(false);
  private closed = false;

  constructor(readonly name: string) {}

  close(): void { this.closed = true; }

  async load(): Promise<void> {
    await this.guarded(async () => {
      this.study.value = await get("/v1/studies/{study}", { study: this.name });
    });
    if (this.study.value && !this.study.value.diagnosis) await this.seek();
  }

  seek(): Promise<void> {
    return mayChange.value ? this.does("/v1/studies/{study}/candidates", {}) : Promise.resolve();
  }
  add = (term: string): Promise<void> => this.changes("/v1/studies/{study}/add", { term });
  tryModel = (model: string): Promise<void> => this.changes("/v1/studies/{study}/try", { model });
  undo = (): Promise<void> => this.changes("/v1/studies/{study}/undo", {});
  redo = (): Promise<void> => this.changes("/v1/studies/{study}/redo", {});

  async back(steps: number): Promise<void> {
    for (let i = 0; i < steps && !this.problem.value; ++i) await this.does("/v1/studies/{study}/undo", {});
    if (!this.problem.value) await this.seek();
  }

  async branch(name: string): Promise<boolean> {
    await this.does("/v1/studies/{study}/branch", { name });
    await listStudies();
    return !this.problem.value;
  }

  /** Draws what a term would do. What a candidate promises is known already. */
  async foresee(term: string): Promise<void> {
    const known = this.study.value?.diagnosis?.candidates.some((one) => one.term === term && one.next);
    if (!known && term) {
      const study = this.study.value;
      await this.does("/v1/studies/{study}/preview", { term });
      this.study.value = study;
      if (this.problem.value) return;
    }
    this.preview.value = term;
  }

  // Afterwards the new model has not been compared with the known effects.
  private async changes<Path extends keyof Posts>(path: Path, body: Posts[Path]["body"]): Promise<void> {
    this.preview.value = "";
    await this.does(path, body);
    void listStudies().catch(() => undefined);
    if (!this.problem.value) await this.seek();
  }

  private async does<Path extends keyof Posts>(path: Path, body: Posts[Path]["body"]): Promise<void> {
    await this.guarded(async () => {
      let job = (await post(path, { study: this.name }, body)) as Job;
      this.job.value = job.job;
      jobs.value = new Map(jobs.value).set(job.job, job);
      while (!over(job) && !this.closed) {
        await this.news(job.job);
        job = await get("/v1/jobs/{job}", { job: job.job });
      }
      jobs.value = new Map(jobs.value).set(job.job, { ...job });
      if (job.state === "failed") throw new Error(job.error);
      if (job.result && path !== "/v1/studies/{study}/branch") this.study.value = job.result;
    });
  }

  // Until the stream tells that the job is over, or a while later: streams may break.
  private news(job: string): Promise<void> {
    return new Promise((go) => {
      const end = (): void => { clearTimeout(timer); stop(); go(); };
      const timer = setTimeout(end, 300);
      const stop = jobs.subscribe((all) => {
        const now = all.get(job);
        if (now && over(now)) queueMicrotask(end);
      });
    });
  }

  private async guarded(work: () => Promise<void>): Promise<void> {
    this.busy.value = true;
    this.problem.value = "";
    try {
      await work();
    } catch (error) {
      this.problem.value = (error as Refused).message;
    } finally {
      this.busy.value = false;
    }
  }
}
