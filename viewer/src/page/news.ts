// Takes what the server tells of new, remade and evicted grids.

import { outdatedBy } from '../time/outdated';
import { Region, isRegion, times } from '../wire/api';
import { App } from './app';
import { Loader } from './loader';
import { mostTimes, soonTimes } from './showing';
import { texts } from './texts';

// Greatest time from a grid to the instants of regions that it is in: a volume takes some minutes, and the
// instants are at most 15 minutes away.
const farthestMadeMs = 30 * 60 * 1000;

export class News {
    constructor(private app: App) {}

    // Call after news were lost: asks for all lists, and forgets all grids, because any may have been made again.
    async catchUp(): Promise<void> {
        const { app } = this;
        if (!app.book || app.domains.length === 0) return app.begin();
        await app.findDomains();
        app.tell('choices');
        const { state, shown } = app;
        app.loader.forgetAll(() => true);
        if (app.isOnMap) return;
        if (!shown) return app.choose(state.domain, app.askedMoment);
        // Ask again for what the user chose while there was no answer.
        if (shown.domain !== state.domain || shown.moment !== state.moment)
            return app.choose(state.domain, app.askedMoment);
        if (isRegion(state.domain)) return this.takeNewsOfSite(undefined);
        await this.takeNews(state.domain, state.moment, shown.time, '', mostTimes);
    }
    // If the time that a user looks at was evicted, moves to the nearest, and the page says so. If the user
    // waits for a time that was missed, moves to the time that is nearest to it now.
    private takeNewTimes(stored: string[]): void {
        const { app } = this;
        const [now, missedTime] = [app.timeline.now, app.missedTime];
        app.timeline.take(stored);
        const { at: shown, times: all, follows, isPlaying } = app.player;
        if (now === undefined || shown < 0 || follows || isPlaying) return;
        if (missedTime !== '' && app.timeline.find(missedTime)) app.miss('');
        else if (missedTime === '' && !all.includes(now)) app.miss(texts.notice.otherTime(now), now);
    }
    private isPartOfShown(domain: string | undefined): boolean {
        const { app } = this;
        const own = app.domains.find((one) => one.domain === app.state.domain) as Region | undefined;
        return (
            domain === app.state.domain ||
            (isRegion(app.state.domain) && (own?.moments.some((one) => one.sites.includes(domain ?? '')) ?? false))
        );
    }
    // Takes a new volume of a site of the shown region: any instant near it may have become another one. If
    // `volume` is undefined, any instant at all may have.
    private async takeNewsOfSite(volume: string | undefined): Promise<void> {
        const { app } = this;
        const { domain, moment } = app.state;
        const isLeft = app.showing.whetherLeft();
        await app.findRegion(domain);
        if (isLeft()) return;
        const isNear = (time: string) =>
            volume === undefined || Math.abs(Date.parse(time) - Date.parse(volume)) <= farthestMadeMs;
        const of = `${domain}/${moment}/`;
        app.loader.forgetAll((key) => key.startsWith(of) && isNear(key.slice(of.length)));
        const stored = (await times(domain, moment, soonTimes)).times;
        if (isLeft()) return;
        this.takeNewTimes(stored);
        await app.showing.showTime();
    }

    // Takes other times of the server. `changedTime` is the time of a grid that was made again, `oldest` the first time
    // that is left after others were evicted.
    async takeNews(
        domain: string | undefined,
        moment: string | undefined,
        changedTime: string | undefined,
        oldest = '',
        most = soonTimes,
    ): Promise<void> {
        const { app } = this;
        if (app.domains.length === 0) {
            if (!app.book) return app.begin();
            await app.findDomains();
            if (app.domain) await app.choose(app.state.domain, app.state.moment);
            return;
        }
        // A moment may come after the others of its station.
        const isKnown = app.domains.some(
            (one) =>
                one.domain === domain && (moment === undefined || one.moments.some((own) => own.moment === moment)),
        );
        if (domain !== undefined && !domain.includes('.') && !isKnown) {
            await app.findDomains();
            app.tell('choices');
        }
        const isOfShown = domain === app.state.domain && moment === app.state.moment;
        const isOld = changedTime
            ? outdatedBy(
                  `${domain}/${moment}`,
                  changedTime,
                  isOfShown ? app.timeline.stored : [],
                  `${app.state.domain}/${app.state.moment}`,
              )
            : () => false;
        app.loader.forgetAll(isOld);
        // A surface may be that of another moment.
        const isOfSurface = moment !== undefined && moment === app.state.layers.surface?.moment;
        if (!this.isPartOfShown(domain) || (moment !== app.state.moment && !isOfSurface)) return;
        if (domain !== app.state.domain) return this.takeNewsOfSite(changedTime);
        if (moment !== app.state.moment) return changedTime === app.shown?.time ? app.showing.showTime() : undefined;
        const before = app.timeline.now;
        const { times: newest, more } = await times(domain, moment, most);
        if (domain !== app.state.domain || moment !== app.state.moment) return;
        // If the server has no more, it has evicted the older ones.
        this.takeNewTimes([
            ...app.timeline.stored.filter((time) => more && time >= oldest && time < newest[0]!),
            ...newest,
        ]);
        const now = app.timeline.now;
        const isOfNow = now !== undefined && isOld(Loader.key(domain, moment, now));
        // If a load failed, the picture may be of another time.
        if (now !== before || now !== app.shown?.time || isOfNow || now === changedTime) await app.showing.showTime();
        else app.tell('time');
    }
}
